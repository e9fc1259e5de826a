"""Samples per second of the peers' rainflow counts on the narrow-band signal of bench/rainflow_bench.cpp, in memory, on one core, and whether
their damage is ours: pip install rainflow pylife fatpack (each alone will do). What is not installed is named and left out; with none of
them the exit code is 77.

    python3 bench/peers/rainflow_peers.py [SAMPLES]        2 million by default: `rainflow` is plain Python
"""

import math
import sys
import time


def signal(count):
    return [math.sin(i * 0.35) * (60 + 40 * math.sin(i * 0.000731)) + 20 * math.sin(i * 0.0123) for i in range(count)]


def rainflow_pypi(samples):
    import rainflow

    return sum(count * (span / 2) ** 5 for span, count in rainflow.count_cycles(samples))


def fatpack_pypi(samples):
    import fatpack
    import numpy

    reversals, _ = fatpack.find_reversals(numpy.asarray(samples))
    cycles, residue = fatpack.find_rainflow_cycles(reversals)
    rest = numpy.abs(numpy.diff(residue)) / 2
    return float(((numpy.abs(cycles[:, 1] - cycles[:, 0]) / 2) ** 5).sum() + 0.5 * (rest**5).sum())


def pylife_pypi(samples):
    import numpy
    import pylife.stress.rainflow as RF

    recorder = RF.LoopValueRecorder()
    detector = RF.FourPointDetector(recorder=recorder)
    detector.process(numpy.asarray(samples))
    loops = numpy.abs(numpy.asarray(recorder.values_from) - numpy.asarray(recorder.values_to)) / 2
    rest = numpy.abs(numpy.diff(detector.residuals)) / 2
    return float((loops**5).sum() + 0.5 * (rest**5).sum())


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 2_000_000
    samples = signal(count)
    ran = []
    for name, peer in (("rainflow", rainflow_pypi), ("fatpack", fatpack_pypi), ("pylife", pylife_pypi)):
        try:
            before = time.process_time()
            damage = peer(samples)
            seconds = time.process_time() - before
        except ImportError as missing:
            print(f"SKIPPED {name}: {missing}: no peer for bench_rainflow (pip install {name})")
            continue
        ran.append(damage)
        print(f"{name}: {count / seconds / 1e6:.3f} million samples/s, sum of amplitude^5 with half cycles {damage:.9g}")
    if ran and max(ran) > min(ran) * (1 + 1e-9):
        print("the peers' sums differ: residuals are counted otherwise")
    return 0 if ran else 77


if __name__ == "__main__":
    sys.exit(main())
