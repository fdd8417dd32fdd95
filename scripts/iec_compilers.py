"""Outside compilers of IEC 61131-3 that build beside the project: a block becomes a program that reads rows of numbers
and writes rows of numbers. interop and yardstick use it. Nothing is fetched; whichever compiler is there is found.

HYSTERON_MATIEC names a folder with MATIEC's iec2c and its lib; without it, iec2c is looked for in PATH. HYSTERON_STRUCPP
names the folder of the package strucpp, built (dist/node/cli.js and src/runtime/include)."""
import os
import re
import shutil
import struct
import subprocess
from pathlib import Path

FLAGS = ["-O1", "-w", "-fwrapv", "-ffp-contract=off", "-frounding-math"]

# A row has one number more than there are inputs, so that a diagram without inputs has rows too. A TIME is a number of
# seconds in a row.
MATIEC_HOST = """#include <math.h>
#include <stdio.h>
#include "iec_std_lib.h"
#include "accessor.h"
#include "POUS.h"
TIME __CURRENT_TIME;
BOOL __DEBUG;
#include "POUS.c"
static TIME time_of(double seconds) {{
  const long long ns = llround(seconds * 1e9);
  TIME time = {{ns / 1000000000, ns % 1000000000}};
  return time;
}}
static double seconds_of(TIME time) {{ return (time.tv_sec * 1000000000LL + time.tv_nsec) / 1e9; }}
int main(void) {{
  static {block} block;
  {block}_init__(&block, 0);
  long long now = 0;
  for (double row[{inputs} + 1]; fread(row, sizeof(row), 1, stdin) == 1; now += {step_ns}) {{
    __CURRENT_TIME.tv_sec = now / 1000000000;
    __CURRENT_TIME.tv_nsec = now % 1000000000;
{sets}    {block}_body__(&block);
    const double results[] = {{{gets}}};
    fwrite(results, sizeof(results), 1, stdout);
  }}
  return 0;
}}
"""

STRUCPP_HOST = """#include <cmath>
#include <cstdio>
#include "block.hpp"
using namespace strucpp;
static double seconds_of(const IEC_TIME& time) {{ return static_cast<double>(static_cast<TIME_t>(time)) / 1e9; }}
int main() {{
  static {block} block;
  for (double row[{inputs} + 1]; std::fread(row, sizeof(row), 1, stdin) == 1; __CURRENT_TIME_NS += {step_ns}) {{
{sets}    block();
    const double results[] = {{{gets}}};
    std::fwrite(results, sizeof(results), 1, stdout);
  }}
}}
"""


def first_line(text, otherwise):
    return text.strip().splitlines()[0] if text.strip() else otherwise


class Matiec:
    name = "MATIEC"

    def __init__(self, folder, options=()):
        self.folder = folder
        self.options = options

    @classmethod
    def found(cls, options=()):
        named = os.environ.get("HYSTERON_MATIEC")
        found = shutil.which("iec2c")
        folder = Path(named) if named else Path(found).resolve().parent if found else None
        return cls(folder.resolve(), options) if folder and (folder / "iec2c").exists() else None

    def command(self, source, folder):
        """Writes POUS.c and its headers into the folder."""
        return [self.folder / "iec2c", *self.options, "-I", self.folder / "lib", "-T", folder, source]

    def translate(self, source, folder):
        """Runs the command; a sentence where the text is refused, else None."""
        done = subprocess.run(self.command(source, folder), capture_output=True, text=True, errors="replace")
        if done.returncode:
            return re.sub(r"^.*?: error: ", "", first_line(done.stderr + done.stdout, "refused"))
        return None

    def host(self, source, block, inputs, outputs, folder, step_ns=0):
        """A program that runs the block over rows of numbers; or a sentence why there is none. Inputs and outputs are
        names with their types; `step_ns` is the time from one row to the next."""
        refused = self.translate(source, folder)
        if refused:
            return refused

        def member(name):
            return re.sub(r"^(\w+)\[(\d+)\]$", r"\1.value.table[\2]", name) if "[" in name else name + ".value"

        sets = "".join(f"    block.{member(name)} = " + (f"time_of(row[{i}]);\n" if kind == "TIME" else f"row[{i}];\n")
                       for i, (name, kind) in enumerate(inputs))
        gets = ", ".join((f"seconds_of(block.{member(name)})" if kind == "TIME" else f"block.{member(name)}")
                         for name, kind in outputs)
        (folder / "host.c").write_text(MATIEC_HOST.format(block=block, inputs=len(inputs), sets=sets, gets=gets,
                                                          step_ns=step_ns))
        lib = self.folder / "lib/C"
        made = subprocess.run(["cc", *FLAGS, f"-I{lib}", f"-I{folder}", folder / "host.c", "-lm", "-o", folder / "host"],
                              capture_output=True, text=True)
        return folder / "host" if made.returncode == 0 else "its C: " + first_error(made.stderr)


class Strucpp:
    name = "STruC++"

    def __init__(self, folder):
        self.folder = folder

    @classmethod
    def found(cls):
        named = os.environ.get("HYSTERON_STRUCPP")
        return cls(Path(named).resolve()) if named and (Path(named) / "dist/node/cli.js").exists() else None

    def command(self, source, folder):
        """Writes block.cpp and what else it needs into the folder."""
        # Of the libraries that come with it only those of the standard: others define what a user's text defines.
        standard = folder / "libraries"
        standard.mkdir()
        for one in self.folder.glob("libs/iec-*"):
            shutil.copy(one, standard)
        return ["node", self.folder / "dist/node/cli.js", source, "--no-default-libs", "-L", standard, "-o",
                folder / "block.cpp"]

    def translate(self, source, folder):
        """As Matiec.translate."""
        done = subprocess.run(self.command(source, folder), capture_output=True, text=True, errors="replace")
        errors = re.findall(r": error: (.*)", done.stderr + done.stdout)
        if done.returncode or errors:
            return errors[0] if errors else "refused"
        return None

    def host(self, source, block, inputs, outputs, folder, step_ns=0):
        """As Matiec.host."""
        refused = self.translate(source, folder)
        if refused:
            return refused

        def member(name):
            return re.sub(r"\[(\d+)\]", r".at(\1)", name)

        sets = "".join(f"    block.{member(name)} = " +
                       (f"static_cast<TIME_t>(std::llround(row[{i}] * 1e9));\n" if kind == "TIME" else f"row[{i}];\n")
                       for i, (name, kind) in enumerate(inputs))
        gets = ", ".join((f"seconds_of(block.{member(name)})" if kind == "TIME"
                          else f"static_cast<double>(block.{member(name)})") for name, kind in outputs)
        (folder / "host.cpp").write_text(STRUCPP_HOST.format(block=block, inputs=len(inputs), sets=sets, gets=gets,
                                                             step_ns=step_ns))
        made = subprocess.run(["c++", "-std=c++17", *FLAGS, f"-I{self.folder}/src/runtime/include", f"-I{folder}",
                               *sorted(folder.glob("block*.cpp")), folder / "host.cpp", "-o", folder / "host"],
                              capture_output=True, text=True)
        return folder / "host" if made.returncode == 0 else "its C++: " + first_error(made.stderr)


def first_error(text):
    return first_line("\n".join(re.findall(r"error: (.*)", text)), "refused")


def rows_of(host, rows, width):
    """What the program of a block gives for rows of inputs: a list of rows of `width` numbers, or a sentence."""
    data = b"".join(struct.pack(f"{len(row) + 1}d", *row, 0.0) for row in rows)
    ran = subprocess.run([host], input=data, capture_output=True)
    if ran.returncode or len(ran.stdout) != 8 * width * len(rows):
        return "its program stops"
    return [struct.unpack_from(f"{width}d", ran.stdout, 8 * width * i) for i in range(len(rows))]
