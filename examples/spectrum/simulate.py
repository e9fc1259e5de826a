"""The files of this folder: python3 simulate.py. Standard library only.

Tests: S_f = S_a/(1 - S_m/S_ut) = a N^b with a = 2000 MPa, b = -0.12, S_ut = 1200 MPa; log10 N scatters with a standard deviation
of 0.15. Tests are stopped after 2e6 cycles. Loads: 3000 samples of the stress at the same place of a part, of 350 km of road:
vibration of a slowly changing size about a mean of 60 MPa, braking and potholes.
"""
import math
import random

A, B, S_UT, SIGMA, END = 2000.0, -0.12, 1200.0, 0.15, 2e6
LEVELS = [(600, -1, 3), (500, -1, 3), (430, -1, 4), (380, -1, 4), (350, 0.1, 3), (300, 0.1, 4), (260, 0.1, 4)]

random.seed(21)
with open("tests.csv", "w") as out:
    out.write("amplitude [MPa],stress_ratio,cycles,status\n")
    for amplitude, ratio, count in LEVELS:
        mean = amplitude * (1 + ratio) / (1 - ratio)
        reversed_amplitude = amplitude / (1 - mean / S_UT)
        for _ in range(count):
            life = 10 ** (math.log10(reversed_amplitude / A) / B + SIGMA * random.gauss(0, 1))
            status = "failure" if life < END else "runout"
            out.write(f"{amplitude},{ratio},{min(life, END):.4g},{status}\n")

with open("loads.csv", "w") as out:
    out.write("time [s],stress [MPa]\n")
    brake, hole = 0.0, 0.0
    for i in range(3000):
        t = i / 20
        brake = 0.98 * brake + (90 if random.random() < 0.004 else 0)
        hole = -0.6 * hole + (random.expovariate(1 / 220) if random.random() < 0.006 else 0)
        size = 140 + 80 * math.sin(0.11 * t) + 25 * random.gauss(0, 1)
        out.write(f"{t:.2f},{60 + brake + hole + size * math.sin(6.1 * t) + 10 * random.gauss(0, 1):.1f}\n")
