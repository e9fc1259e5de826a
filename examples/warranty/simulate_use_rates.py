"""Simulates water pumps of cars whose mileage is known at a failure, and of a few others from service visits.

Life in km is Weibull (scale 110 000 km, shape 1.8), use per month lognormal (median 1300 km/month, log_sd 0.55), independent.
Cars are sold over three years; the table is that of one day. Run: python3 simulate_use_rates.py > use_rates.csv
"""
import math
import random

rng = random.Random(20261126)
print("age_month,km,status")
for car in range(400):
    rate = 1300 * math.exp(0.55 * rng.gauss(0, 1))
    life = rng.weibullvariate(110_000, 1.8)
    age = rng.uniform(1, 36)
    if life < rate * age:
        print(f"{life / rate:.2f},{life:.0f},failed")
    elif rng.random() < 0.1:
        print(f"{age:.2f},{rate * age:.0f},running")
    else:
        print(f"{age:.2f},,running")
