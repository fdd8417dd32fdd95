"""What is installed works where it lies: the program, its pages and completions, find_package, and Debian's packages."""
import importlib.util
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

BUILD = Path(os.environ["HYSTERON_BUILD"])
DIAGRAM = """FUNCTION_BLOCK AXIS  (* @ts 1ms *)
  VAR_INPUT
    TARGET : LREAL;
  END_VAR
  VAR_OUTPUT
    U : LREAL;
  END_VAR
  VAR
    LAG : HY_LAG := (T1 := 0.02);
  END_VAR

  LAG(XIN := TARGET);
  U := LAG.XOUT;
END_FUNCTION_BLOCK
"""
OUTSIDE = """FUNCTION_BLOCK OUTSIDE  (* @ts 1ms *)
  VAR_INPUT
    TARGET : LREAL;
  END_VAR
  VAR_OUTPUT
    U : LREAL;
  END_VAR
  VAR
    AXIS : HY_FMU;  (* @file axis.fmu *)
  END_VAR

  U := AXIS.U;
  AXIS(TARGET := TARGET);
END_FUNCTION_BLOCK
"""
PROJECT = """cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES CXX)
find_package(hysteron REQUIRED)
hysteron_add_diagram(axis axis.st PARAMS axis.toml)
add_executable(user main.cpp)
target_link_libraries(user PRIVATE axis)
add_executable(library library.cpp)
target_compile_features(library PRIVATE cxx_std_20)
target_link_libraries(library PRIVATE hysteron::blocks hysteron::runtime)
add_executable(api api.cpp)
target_link_libraries(api PRIVATE hysteron::c)
"""
MAIN = """#include <cstdio>
#include "axis.hpp"
int main() {
  const axis::Params params;
  axis::State state;
  reset(params, state);
  axis::In in;
  in.target = 1.0;
  for (int k = 0; k < 3; ++k) {
    std::printf("%.17g\\n", step(params, state, in).u);
  }
}
"""
LIBRARY = """#include "blocks/lag.hpp"
#include "runtime/host/host_program.hpp"
int main() {}
"""
API = """#include <hysteron.h>
#include <cstdio>
int main() { std::puts(hysteron_version()); }
"""
SCRIPT = """import sys, hysteron
axis = hysteron.compile("axis.st", LAG={"T1": 0.05})
print(hysteron.__file__)
print(*axis.run({"TARGET": [1.0, 1.0, 1.0]})["U"].tolist())
"""


def run(*command, **options):
    done = subprocess.run([str(one) for one in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{command} ended with {done.returncode}:\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
    return done.stdout


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.work = Path(cls.folder.name)
        cls.prefix = cls.work / "prefix"
        run("cmake", "--install", BUILD, "--prefix", cls.prefix)
        cls.program = cls.prefix / "bin/hysteron"

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_the_program_runs_without_its_source(self):
        self.assertIn("hysteron ", run(self.program, "--version", cwd=self.work))
        (self.work / "axis.st").write_text(DIAGRAM)
        run(self.program, "check", "axis.st", cwd=self.work)
        self.assertIn("# HY402", run(self.program, "explain", "hy402", cwd=self.work))

    def test_the_gateway_of_opc_ua_lies_beside_it_without_what_npm_brings(self):
        folder = self.prefix / "share/hysteron/opcua"
        self.assertFalse((folder / "node_modules").exists())
        self.assertTrue(os.access(folder / "hysteron-opcua.js", os.X_OK))
        self.assertTrue((folder / "package-lock.json").is_file())
        if shutil.which("node"):
            self.assertIn("--task URL", run(folder / "hysteron-opcua.js", "--help", cwd=self.work))

    def test_an_fmu_is_run_without_the_source(self):
        (self.work / "axis.st").write_text(DIAGRAM)
        (self.work / "outside.st").write_text(OUTSIDE)
        (self.work / "log.csv").write_text("t,TARGET\n0.000,1.0\n0.001,1.0\n0.002,1.0\n")
        run(self.program, "generate", "axis.st", "--target", "fmu", "--out", ".", cwd=self.work)
        inside = run(self.program, "run", "axis.st", "--in", "log.csv", "--out", "-", cwd=self.work).splitlines()
        outside = run(self.program, "run", "outside.st", "--in", "log.csv", "--out", "-", cwd=self.work).splitlines()
        self.assertEqual([line.split(",")[1] for line in inside[1:-1]], [line.split(",")[1] for line in outside[2:]])

    def test_each_command_has_a_manual_page(self):
        pages = self.prefix / "share/man/man1"
        commands = [line.split()[0] for line in run(self.program, "--help").split("Commands:")[1].split("\n\n")[0].splitlines() if line]
        self.assertGreater(len(commands), 10)
        for command in commands:
            page = (pages / f"hysteron-{command}.1").read_text()
            self.assertTrue(page.startswith(".TH HYSTERON-"), page[:80])
            if shutil.which("man"):
                shown = run("man", "-l", pages / f"hysteron-{command}.1", env={**os.environ, "MANPAGER": "cat", "LC_ALL": "C.UTF-8"})
                self.assertIn("NAME", shown)
        self.assertIn("--resample", (pages / "hysteron-run.1").read_text().replace("\\-", "-"))

    def test_bash_completes_commands_options_and_words(self):
        script = self.prefix / "share/bash-completion/completions/hysteron"

        def completed(*words):
            line = " ".join(f"'{word}'" for word in words)
            return run("bash", "-c", f"source '{script}'; COMP_WORDS=({line}); COMP_CWORD={len(words) - 1}; _hysteron; "
                       'echo "${COMPREPLY[@]}"').split()

        self.assertEqual(completed("hysteron", "tu"), ["tune"])
        self.assertEqual(completed("hysteron", "run", "--res"), ["--resample"])
        self.assertEqual(completed("hysteron", "run", "--resample", "h"), ["hold"])

    def test_a_project_finds_the_package_and_generates_its_step(self):
        user = self.work / "user"
        user.mkdir()
        for name, text in {"CMakeLists.txt": PROJECT, "axis.st": DIAGRAM, "main.cpp": MAIN, "library.cpp": LIBRARY, "api.cpp": API,
                           "axis.toml": "[parameters.LAG]\nT1 = 0.05\n"}.items():
            (user / name).write_text(text)
        run("cmake", "-S", user, "-B", user / "build", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        run("cmake", "--build", user / "build")
        (user / "log.csv").write_text("t,TARGET\n0.000,1\n0.001,1\n0.002,1\n")
        run(self.program, "run", "axis.st", "--params", "axis.toml", "--in", "log.csv", "--out", "out.csv", cwd=user)
        wanted = [float(line.split(",")[1]) for line in (user / "out.csv").read_text().splitlines()[1:]]
        self.assertEqual([float(line) for line in run(user / "build/user").split()], wanted)
        self.assertIn(run(user / "build/api").strip(), run(self.program, "--version"))

    @unittest.skipUnless(importlib.util.find_spec("numpy"), "python3-numpy is not installed")
    def test_python_finds_its_package_and_the_library(self):
        folder = self.work / "python"
        folder.mkdir()
        (folder / "axis.st").write_text(DIAGRAM)
        (folder / "script.py").write_text(SCRIPT)
        (folder / "axis.toml").write_text("[parameters.LAG]\nT1 = 0.05\n")
        (folder / "log.csv").write_text("t,TARGET\n0.000,1\n0.001,1\n0.002,1\n")
        packages = self.prefix / "lib/python3/dist-packages"
        bare = {key: value for key, value in os.environ.items() if key != "HYSTERON_LIBRARY"}
        place, values = run("/usr/bin/python3", "script.py", cwd=folder,
                            env={**bare, "PYTHONPATH": str(packages)}).splitlines()
        self.assertEqual(Path(place), packages / "hysteron/__init__.py")
        run(self.program, "run", "axis.st", "--params", "axis.toml", "--in", "log.csv", "--out", "out.csv", cwd=folder)
        wanted = [float(line.split(",")[1]) for line in (folder / "out.csv").read_text().splitlines()[1:]]
        self.assertEqual([float(value) for value in values.split()], wanted)

    @unittest.skipUnless(shutil.which("dpkg-shlibdeps"), "no dpkg-dev")
    def test_packages_of_debian_have_what_is_installed(self):
        packages = self.work / "packages"
        run("cpack", "-G", "DEB", "-B", packages, cwd=BUILD)
        found = {path.name.split("_")[0]: path for path in packages.glob("*.deb")}
        self.assertEqual(set(found), {"hysteron", "hysteron-dev", "libhysteron1", "python3-hysteron"})
        for program in ("hysteron", "hysteron-simulate"):
            self.assertIn(f"./usr/bin/{program}\n", run("dpkg-deb", "-c", found["hysteron"]).replace(" ", "\n"))
        self.assertIn("libmodbus5", run("dpkg-deb", "-f", found["hysteron"], "Depends"))
        for name, file in (("hysteron-dev", "hysteronConfig.cmake"), ("hysteron-dev", "include/hysteron.h"),
                           ("libhysteron1", "libhysteron.so.1"), ("python3-hysteron", "hysteron/_location.py")):
            self.assertIn(file, run("dpkg-deb", "-c", found[name]))
        self.assertIn("coinor-libipopt", run("dpkg-deb", "-f", found["libhysteron1"], "Depends"))
        self.assertIn("python3-numpy", run("dpkg-deb", "-f", found["python3-hysteron"], "Depends"))


if __name__ == "__main__":
    unittest.main()
