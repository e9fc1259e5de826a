#!/usr/bin/env python3
"""The tables of this folder, as a spreadsheet, a logger and a rig would write them: python3 make_files.py

The data are simulated; the truth of each is written beside it. The workbook needs XlsxWriter (python3-xlsxwriter).
"""
import datetime
import math
import random


def german(value, digits):
    """1234.5 as 1.234,50"""
    return f"{value:,.{digits}f}".translate(str.maketrans(",.", ".,"))


def excel_in_germany():
    """A pin on a disc. Truth: k = 5e-6 mm^3/(N m), sigma = 0.04 mm^3, 6 N m a cycle."""
    random.seed(17)
    rows = [["Verschleißprüfung Stift/Scheibe"], ["Prüfer", "Jürgen Müller"], ["Werkstoff", "PA 66 + 15 % PTFE, geölt"], []]
    rows.append(["Nr.", "Lastwechsel", "Reibarbeit [kJ]", "Verschleißvolumen [mm³]", "Temp. (°C)", "Bemerkung"])
    for number, cycles in enumerate([900, 2500, 5000, 10000, 25000, 50000, 100000, 150000, 200000, 250000], 1):
        work = 6.0 * cycles  # J
        volume = 5e-6 * work + 0.04 * random.gauss(0, 1)
        note = {1: "Einlauf", 6: 'Probe "B" nachgezogen', 8: "Öl gewechselt; gereinigt"}.get(number, "")
        rows.append([str(number), german(cycles, 0), german(work / 1000, 1), german(volume, 3), german(22 + 0.4 * number, 1), note])
    width = len(rows[4])
    with open("verschleiss.csv", "wb") as out:
        for row in rows + [[], []]:
            cells = ['"' + c.replace('"', '""') + '"' if ";" in c or '"' in c else c for c in row]
            out.write((";".join(cells + [""] * (width - len(cells))) + "\r\n").encode("cp1252"))


def logger():
    """A joint. Truth: k = 2e-6 mm^3/(N m), sigma = 0.05 mm^3; the work is logged."""
    random.seed(12)
    start = datetime.datetime(2024, 3, 1, 8, 0)
    with open("logger.txt", "w", encoding="utf-16-le", newline="") as out:
        out.write("\ufeffTime\tCycles\tWork\tLoad\tVolume\r\n")
        out.write("\tkcycles\tkJ\tN\tmm³\r\n")
        work = 0.0
        for step in range(1, 13):
            load = 60 + 3 * random.gauss(0, 1)
            work += 25e3 * 0.06 * load
            volume = 2e-6 * work + 0.05 * random.gauss(0, 1)
            at = start + datetime.timedelta(hours=6.5 * step)
            out.write(f"{at:%Y-%m-%d %H:%M}\t{25 * step}\t{work / 1000:.2f}\t{load:.1f}\t{volume:.3f}\r\n")


def rig():
    """A bushing. Truth: k = 1e-6 mm^3/(N m), 2 um of gauge error; depth of the scar by the section of two circles."""
    random.seed(13)
    radius, length, clearance, k = 10.0, 20.0, 0.03, 1e-6  # mm, mm^3/(N m)

    def area(depth):  # of the journal outside the bushing, mm^2, by slices
        big, count = radius + clearance, 4000
        offset, total = clearance + depth, 0.0
        half = math.pi / 2
        for i in range(count):
            angle = -half + (i + 0.5) * 2 * half / count
            # the bushing's edge, seen from the journal's centre
            edge = -offset * math.cos(angle) + math.sqrt(big**2 - (offset * math.sin(angle)) ** 2)
            total += max(0.0, 0.5 * (radius**2 - edge**2)) * 2 * half / count
        return total

    def depth_of(volume):
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if area(middle) * length < volume else (low, middle)
        return low

    with open("rig.csv", "w", encoding="utf-8", newline="") as out:
        out.write("Bushing rig 3, run 2024-117\nOperator: A. Rossi; shaft 42CrMo4, bushing PEEK\nGauge error: 2 um (k=1)\n\n")
        out.write("bearing, load / N, turns (1000), depth_um, remark\n")
        for name, load in zip(["L-01", "L-02", "L-03"], [400, 500, 650]):
            out.write(f"# --- {name} mounted, clearance checked\n")
            for turns in [50, 100, 200, 400]:
                volume = k * load * turns * 1000 * 2 * math.pi * radius / 1000
                depth = depth_of(volume) * 1000 + 2 * random.gauss(0, 1)
                remark = '"warm, 60 degC"' if turns == 200 else ""
                out.write(f"{name}, {load}, {turns}, {depth:.1f}, {remark}\n")
            if name == "L-02":
                out.write("# power cut, 2 h; nothing moved\n")


def workbook():
    """Specimens of a steel. Truth: S = 1800 MPa N^-0.1, log10 N scatters by 0.15; stopped after 2 million cycles."""
    import xlsxwriter

    random.seed(14)
    book = xlsxwriter.Workbook("woehler.xlsx")
    info, tests = book.add_worksheet("Info"), book.add_worksheet("Versuche")
    date = book.add_format({"num_format": "dd.mm.yyyy"})
    thousands = book.add_format({"num_format": "#,##0"})
    info.write_row("A1", ["Wöhlerversuch", "Werkstoff 42CrMo4, R = -1"])
    tests.write("B2", "Wöhlerversuch, axial")
    tests.write_row("B4", ["Datum", "Probe", "Kraft / kN", "Spannungsamplitude [MPa]", "Schwingspiele", "Status"])
    row = 4
    for stress, count in [(600, 3), (540, 3), (490, 4), (450, 4), (420, 4)]:
        for _ in range(count):
            life = 10 ** (math.log10(stress / 1800) / -0.1 + 0.15 * random.gauss(0, 1))
            status = "failure" if life < 2e6 else "runout"
            tests.write_datetime(row, 1, datetime.datetime(2024, 3, 1) + datetime.timedelta(days=row), date)
            tests.write(row, 2, f"P{row - 3:02d}")
            tests.write_number(row, 3, stress * 50.0 / 1000)
            # The formula that the value was worked out by: amplitude over a section of 50 mm^2.
            tests.write_formula(row, 4, f"=D{row + 1}*1000/50", None, stress)
            tests.write_number(row, 5, round(min(life, 2e6)), thousands)
            tests.write(row, 6, status)
            row += 1
    tests.write(row + 1, 1, "Mittelwert")
    tests.write_formula(row + 1, 5, f"=AVERAGE(F5:F{row})", None, 1.0)
    book.close()


excel_in_germany()
logger()
rig()
workbook()
