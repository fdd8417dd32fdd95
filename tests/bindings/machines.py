"""Diagrams, records and the tool, for the tests of the bindings."""
import csv
import os
import subprocess

import numpy

TOOL = os.environ["HYSTERON_TOOL"]

PLANT = """FUNCTION_BLOCK PLANT  (* @ts 1ms *)
  VAR_INPUT
    U : LREAL;  (* @unit V @min -10 @max 10 *)
    HOLD_IT : BOOL := FALSE;
  END_VAR
  VAR_OUTPUT
    Y : LREAL;  (* @unit um *)
    COUNT : DINT;
  END_VAR
  VAR
    HYST : HY_HYSTERESIS_RO := (C1 := 8.0, C2 := 1.0, C3 := 1.0);
    AMP  : HY_LAG           := (T1 := 0.004);
    N    : HY_CTU;
  END_VAR

  AMP(XIN := SEL(HOLD_IT, U, 0.0));
  HYST(XIN := AMP.XOUT);
  N(CU := HOLD_IT, PV := 5);
  Y := HYST.XOUT;
  COUNT := N.CV;
END_FUNCTION_BLOCK
"""

MACHINE = PLANT.replace("C1 := 8.0, C2 := 1.0, C3 := 1.0", "C1 := 9.0, C2 := 1.5, C3 := 0.8").replace("0.004", "0.012")

SETTINGS = """[parameters.HYST]
C1 = 8.0   # a guess

[fit.HYST]
C1 = {min = 4.0}
C2 = {}
C3 = {max = 4.0}

[tune]
train = [0.0, 1.0]
test = [1.0, 2.0]
"""


def drive(rows=2000, seed=7):
    """A voltage with reversals, and a switch."""
    t = numpy.arange(rows) / 1000.0
    u = 1.2 * (1.0 - numpy.cos(9.0 * t)) + 0.6 * numpy.sin(23.0 * t) ** 2
    return {"t": t, "U": u, "HOLD_IT": (numpy.random.default_rng(seed).random(rows) < 0.01).astype(float)}


def write_csv(path, columns):
    """With the shortest texts that read back to the same bits."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([repr(float(value)) for value in row] for row in zip(*columns.values()))


def read_csv(path):
    with open(path, encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return {name: numpy.array([float(row[i]) for row in rows[1:]]) for i, name in enumerate(rows[0])}


def tool(*arguments, cwd, exit_code=0):
    done = subprocess.run([TOOL, *map(str, arguments)], cwd=cwd, capture_output=True, text=True)
    assert done.returncode == exit_code, f"{arguments} ended with {done.returncode}:\n{done.stdout}\n{done.stderr}"
    return done
