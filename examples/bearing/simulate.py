#!/usr/bin/env python3
"""Simulates the inspections of eight dry-running bearings: python3 simulate.py > inspections.csv

The data are not measured. The truth behind them:
  k          2.0e-6 mm^3/(N m), the median over bearings
  k_scatter  0.25, the standard deviation of ln k between bearings
  sigma      2 um, the standard deviation of one measured depth
Each bearing has a journal of 10 mm radius in a standing bushing 20 mm long, under its own constant
force, and is measured three times.
"""
import csv
import math
import random
import sys

K, SCATTER, SIGMA = 2.0e-15, 0.25, 2e-6  # m^3/(N m), 1, m
RADIUS, LENGTH = 10e-3, 20e-3  # m


def wear_number(sigma, delta):
    """A/(4 pi r^2) of the journal's circle outside the bushing's: Ligterink and de Gee (1996)."""
    a = math.acos((2 * sigma - 2 * sigma * delta - delta**2) / (2 * (sigma + delta)))
    b = math.acos((2 * sigma + 2 * sigma**2 + 2 * sigma * delta + delta**2) / (2 * (1 + sigma) * (sigma + delta)))
    return (2 * a - math.sin(2 * a) - (1 + sigma) ** 2 * (2 * b - math.sin(2 * b))) / (8 * math.pi)


def depth_for(sigma, number):
    low, high = 1e-6, 1.0
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if wear_number(sigma, middle) < number else (low, middle)
    return low


def main():
    random.seed(2)
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(["bearing", "clearance_um", "force_N", "revolutions", "depth_um"])
    for name, clearance, force in zip("ABCDEFGH", [25, 35, 30, 28, 32, 27, 33, 30], [400, 400, 400, 600, 600, 800, 800, 800]):
        k = K * math.exp(SCATTER * random.gauss(0, 1))
        for revolutions in (50_000, 100_000, 200_000):
            number = k * force / (2 * RADIUS * LENGTH) * revolutions
            depth = RADIUS * depth_for(clearance * 1e-6 / RADIUS, number) + SIGMA * random.gauss(0, 1)
            out.writerow([name, clearance, force, revolutions, f"{depth * 1e6:.1f}"])


if __name__ == "__main__":
    main()
