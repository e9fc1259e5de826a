# make run, make test: each does all its own set-up on a fresh Debian 12 machine, and nothing twice.
.PHONY: run test build calibrate sanitize bench format clean

run: setup
	@cmake --preset release >/dev/null
	@cmake --build --preset release --target wearwell
	@build/release/bin/wearwell fit examples/joint/study.toml -o build/joint-results

test: build
	@ctest --preset release

# Simulation-based calibration: slow, so apart from `make test`.
calibrate: build
	@ctest --preset calibration

# Debian's oneTBB is not instrumented: to the thread sanitizer, all that is handed over through it looks
# like a race. So that sanitizer looks at what runs on threads of our own.
sanitize: setup-tests
	@cmake --preset asan-ubsan >/dev/null && cmake --build --preset asan-ubsan && ctest --preset asan-ubsan
	@cmake --preset tsan >/dev/null && cmake --build --preset tsan --target test_base test_regress
	@build/tsan/bin/test_base && build/tsan/bin/test_regress

bench: build
	@bench/run

build: setup-tests
	@cmake --preset release >/dev/null
	@cmake --build --preset release

.PHONY: setup setup-tests
setup:
	@setup/install

setup-tests:
	@setup/install --tests

format:
	@git ls-files '*.h' '*.cpp' | xargs clang-format -i

clean:
	@rm -rf build
