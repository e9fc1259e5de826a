#!/usr/bin/env python3
"""Lives of seals as a fit may leave them: of a new one in five populations that the data allow, and what remains to eight that run.
Writes lives.csv beside it. Needs nothing but Python."""
import math
import os
import random

random.seed(17)
rows = []
for population in range(1, 6):  # Weibull lives: shape and characteristic life are not known exactly
    shape, scale = random.gauss(2.6, 0.3), random.gauss(5200, 350)
    for i in range(60):
        p = (i + 0.5) / 60
        rows.append((f"{scale * (-math.log(1 - p)) ** (1 / shape):.0f}", 1, "", population))
for seal, median, spread in [("P1", 3400, 0.25), ("P2", 150, 0.6), ("P3", 1900, 0.2), ("P4", 620, 0.35),
                             ("P5", 4100, 0.3), ("P6", 2500, 0.4), ("P7", 900, 0.5), ("P8", 5200, 0.3)]:
    for i in range(33):  # lognormal: points of a rule, with their weights
        z = -4 + 0.25 * i
        rows.append((f"{median * math.exp(spread * z):.1f}", f"{math.exp(-z * z / 2):.6f}", seal, ""))

with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "lives.csv"), "w") as out:
    out.write("life [h],weight,unit,population\n")
    for row in rows:
        out.write(",".join(str(cell) for cell in row) + "\n")
