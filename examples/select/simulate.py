#!/usr/bin/env python3
"""Simulates the wear of a dry clutch at 101 operating points: python3 simulate.py > wear.csv

The data are not measured; their layout is that of Haramina et al. (Appl. Sci. 2025, 15, 8150): 81 points of a full
factorial and 20 beyond it. The truth behind them, with
the temperature Td in C, slip n in rpm, torque Mz in N m and closing time t in s:

  w = 5 - 0.04 Td + 2e-4 Td^2 + 1.2e-5 Td n - 3e-7 n^2 t + 2e-6 Td^2 Mz    [mm^3/MJ]

Each point is the mean of `cycles` closings; its standard deviation is 20 / sqrt(cycles) mm^3/MJ.
"""
import csv
import itertools
import math
import random
import sys


def wear(temperature, slip, torque, time):
    return (5 - 0.04 * temperature + 2e-4 * temperature**2 + 1.2e-5 * temperature * slip
            - 3e-7 * slip**2 * time + 2e-6 * temperature**2 * torque)


def main():
    random.seed(4)
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(["Td", "n", "Mz", "t", "cycles", "w"])
    points = list(itertools.product([120, 170, 240], [1200, 1700, 2800], [25, 50, 75], [0.9, 2.15, 3.4]))
    for _ in range(20):
        points.append((random.uniform(100, 260), random.uniform(1000, 3000), random.uniform(20, 90), random.uniform(0.7, 3.8)))
    for temperature, slip, torque, time in points:
        temperature += random.gauss(0, 3)
        slip += random.gauss(0, 20)
        torque += random.gauss(0, 0.7)
        time += random.gauss(0, 0.03)
        cycles = random.randint(750, 3000)
        w = wear(temperature, slip, torque, time) + 20 / math.sqrt(cycles) * random.gauss(0, 1)
        out.writerow([f"{temperature:.1f}", f"{slip:.0f}", f"{torque:.2f}", f"{time:.3f}", cycles, f"{w:.3f}"])


if __name__ == "__main__":
    main()
