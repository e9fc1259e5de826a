#!/usr/bin/env python3
"""Simulates profile_before.csv and profile_after.csv: a bore around its scar, new and worn.

The data are not measured. The truth behind them: a journal of 10 mm radius with 30 um radial
clearance has sunk 17 um into the bore; the area of that lune is 0.196790 mm^2. The instrument put
the second profile 0.12 mm farther along, 3 um higher and turned by 0.2 um/mm; each profile has a
noise of 0.3 um. The bore's own waves (1 um) are in both.
"""
import csv
import math
import random

RADIUS, CLEARANCE, DEPTH = 10.0, 0.030, 0.017  # mm
BORE = RADIUS + CLEARANCE
SHIFT, RAISED, TURNED, NOISE = 0.12, 3.0, 0.2, 0.3  # mm, um, um/mm, um


def bore(s):
    return 0.7 * math.sin(2 * math.pi * s / 2.3) + 0.5 * math.sin(2 * math.pi * s / 0.9 + 1)


def scar(s):
    """How far the sunken journal reaches beyond the bore, along its radius at the arc s, in um."""
    angle, apart = s / BORE, CLEARANCE + DEPTH
    reach = apart * math.cos(angle) + math.sqrt(RADIUS**2 - (apart * math.sin(angle)) ** 2)
    return 1000 * max(0.0, reach - BORE)


def write(name, height):
    with open(name, "w") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["position_mm", "height_um"])
        for i in range(-320, 321):
            out.writerow([f"{0.05 * i:.2f}", f"{height(0.05 * i) + NOISE * random.gauss(0, 1):.3f}"])


if __name__ == "__main__":
    random.seed(3)
    write("profile_before.csv", bore)
    write("profile_after.csv",
          lambda s: bore(s - SHIFT) - scar(s - SHIFT) + RAISED + TURNED * s)
