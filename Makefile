# make run, make test: each does all its own set-up on a fresh Debian 12 machine, and nothing twice.
.PHONY: run python r docs test install package build calibrate sanitize fuzz tidy bench format clean

run: setup
	@cmake --preset release >/dev/null
	@cmake --build --preset release --target wearwell
	@build/release/bin/wearwell fit examples/joint/study.toml -o build/joint-results

# The Python module as a wheel in build/wheel (docs/reference/python.md).
python: setup-python
	@cmake --preset release -DWEARWELL_BUILD_PYTHON=ON >/dev/null
	@cmake --build --preset release --target wearwell_python
	@WEARWELL_BUILD=$(CURDIR)/build/release /usr/bin/python3 -m pip wheel python/ --no-build-isolation --no-deps -q -w build/wheel
	@echo "$$(ls -t build/wheel/*.whl | head -1): for pip in a virtual environment (docs/reference/python.md)"

# The R package, built, in build/r (docs/reference/r.md).
r: setup-r
	@cmake --preset release -DWEARWELL_BUILD_R=ON >/dev/null
	@cmake --build --preset release --target wearwell_r
	@r/tools/binary build/release build/r
	@echo "R CMD INSTALL $$(ls -t build/r/*.tar.gz | head -1)"

# The site, in build/docs/html: offline, and a warning or a link that leads nowhere is an error.
docs: setup-docs
	@mkdir -p build/docs/doxygen
	@doxygen docs/Doxyfile
	@/usr/bin/python3 -m sphinx -q -W --keep-going -b html -d build/docs/doctrees docs build/docs/html
	@echo "build/docs/html/index.html"

test: build
	@ctest --preset release

# The program, its manual page, completions of bash and zsh, and the library (docs/reference/library.md); PREFIX=$HOME/.local for
# one user.
PREFIX = /usr/local
install: setup
	@cmake --preset release >/dev/null
	@cmake --build --preset release --target wearwell
	@cmake --install build/release --prefix $(PREFIX)

# A Debian package of the program, with a service for monitors (docs/reference/monitor.md).
package: setup
	@cmake --preset release >/dev/null
	@cmake --build --preset release --target wearwell
	@cpack --config build/release/CPackConfig.cmake -B build/package >/dev/null
	@echo "apt install ./$$(ls -t build/package/*.deb | head -1)"

# Simulation-based calibration: slow, so apart from `make test`.
calibrate: build
	@cmake --build --preset release --target calibration
	@ctest --preset calibration

# All tests but those in a browser, under strace, and of programs outside, which know nothing of sanitizers; threads where there
# are any, with a oneTBB that is instrumented too. DuckDB is not: tests/sanitizers/thread.txt.
sanitize: setup-tests setup-clang
	@cmake --preset asan-ubsan >/dev/null && cmake --build --preset asan-ubsan && ctest --preset asan-ubsan
	@setup/thread-sanitizer-tbb
	@cmake --preset tsan >/dev/null && cmake --build --preset tsan && ctest --preset tsan

# Coverage-guided; an hour over all targets, or as many seconds as are asked for (make fuzz SECONDS=600).
SECONDS = 3600
fuzz: setup-tests setup-clang
	@cmake --preset asan-ubsan >/dev/null
	@cmake --build --preset fuzz
	@tests/fuzz/run $(SECONDS)

# clang-tidy over src/, with the chosen checks of .clang-tidy; some minutes.
tidy: setup-clang
	@cmake --preset tidy >/dev/null
	@run-clang-tidy-14 -quiet -p build/tidy '^$(CURDIR)/src/'

bench: build
	@cmake --build --preset release --target bench
	@bench/run

build: setup-tests
	@cmake --preset release >/dev/null
	@cmake --build --preset release

.PHONY: setup setup-python setup-r setup-docs setup-tests setup-clang
setup:
	@setup/install

setup-python:
	@setup/install --python

setup-r:
	@setup/install --r

setup-docs:
	@setup/install --docs

setup-tests:
	@setup/install --tests

setup-clang:
	@setup/install --clang

format:
	@git ls-files '*.h' '*.cpp' | xargs clang-format -i

clean:
	@rm -rf build
