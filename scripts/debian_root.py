"""Systems of Debian in folders: made by debootstrap, entered by chroot, with mounts that end with the run.

For scripts that build or try something where nothing but Debian is. SUITES are the versions that the packages are for."""
import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SUITES = {12: "bookworm", 13: "trixie"}
SOURCE = Path(__file__).resolve().parent.parent
WITHIN = "HYSTERON_OWN_MOUNTS"  # set in the call that has its own mounts
PROXIES = {name: value for name, value in os.environ.items() if name.lower() in ("http_proxy", "https_proxy", "no_proxy")}
BARE = {"PATH": "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "DEBIAN_FRONTEND": "noninteractive",
        "LC_ALL": "C.UTF-8"}


def own_version():
    """The version of Debian that runs this; 0 where it is another system."""
    known = {}
    if Path("/etc/os-release").exists():
        for line in Path("/etc/os-release").read_text().splitlines():
            key, _, value = line.partition("=")
            known[key] = value.strip('"')
    return int(known["VERSION_ID"]) if known.get("ID") == "debian" and known.get("VERSION_ID", "").isdigit() else 0


def missing():
    """Why no such system can be had here; empty where it can."""
    if os.geteuid() != 0:
        return "it needs root, for chroot"
    absent = [name for name in ("debootstrap", "unshare", "chroot") if not shutil.which(name)]
    return f"{', '.join(absent)}: not installed" if absent else ""


def with_own_mounts(script, work):
    """Gives what `work` gives, in a process whose mounts nobody else sees; they end with it, however it ends. 77 where
    that cannot be had."""
    reason = missing()
    if reason:
        print(f"not tried: {reason}")
        return 77
    if WITHIN in os.environ:
        return work()
    return subprocess.run(["unshare", "--mount", sys.executable, script, *sys.argv[1:]], env={**os.environ, WITHIN: "1"}).returncode


@contextlib.contextmanager
def scratch(purpose):
    """A folder for one run, with room for a system."""
    folder = Path(tempfile.mkdtemp(prefix=f"hysteron-{purpose}-", dir="/var/tmp"))
    try:
        yield folder
    finally:
        subprocess.run(["rm", "-rf", "--one-file-system", folder])


def put_sources(folder):
    """The files of this tree, committed or not; what an earlier run built stays."""
    folder.mkdir(exist_ok=True)
    for old in folder.iterdir():
        if old.name != "build":
            shutil.rmtree(old) if old.is_dir() else old.unlink()
    git = ["git", "-c", "safe.directory=*", "-C", SOURCE]
    names = subprocess.run([*git, "ls-files", "-z", "--cached", "--others", "--exclude-standard"], capture_output=True, check=True)
    there = [name for name in names.stdout.split(b"\0") if name and Path(SOURCE, name.decode()).exists()]
    with subprocess.Popen(["tar", "-C", SOURCE, "--null", "-T", "-", "-cf", "-"], stdin=subprocess.PIPE,
                          stdout=subprocess.PIPE) as packing:
        with subprocess.Popen(["tar", "-xf", "-", "-C", folder], stdin=packing.stdout) as unpacking:
            packing.stdin.write(b"\0".join(there))
            packing.stdin.close()
        if packing.wait() != 0 or unpacking.returncode != 0:
            raise SystemExit(f"the sources could not be copied to {folder}")


class Root:
    """A system in a folder. It is made where the folder has none, and must be of the version that is asked for."""

    def __init__(self, folder, version):
        self.folder = Path(folder)
        self.version = version
        suite = SUITES[version]
        if not (self.folder / "usr/bin/apt-get").exists():
            self._make(suite)
        release = (self.folder / "etc/os-release").read_text()
        if f"VERSION_CODENAME={suite}\n" not in release:
            raise SystemExit(f"{self.folder} is no Debian {version} ({suite}): name another folder, and it is made there")

    def _make(self, suite):
        print(f"making a bare system of {suite} in {self.folder}", flush=True)
        with tempfile.NamedTemporaryFile("w+", suffix=".log", prefix="debootstrap-", delete=False) as log:
            if subprocess.run(["debootstrap", "--variant=minbase", suite, self.folder], stdout=log, stderr=log).returncode != 0:
                raise SystemExit(f"debootstrap failed; {log.name} says why")
        os.unlink(log.name)

    def copy(self, folder):
        """The same system in another folder; this one stays as it is."""
        subprocess.run(["cp", "-a", self.folder, folder], check=True)
        return Root(folder, self.version)

    @contextlib.contextmanager
    def mounted(self):
        places = {self.folder / "proc": "proc", self.folder / "dev/shm": "tmpfs"}
        try:
            for place, kind in places.items():
                place.mkdir(exist_ok=True)
                subprocess.run(["mount", "-t", kind, kind, place], check=True)
            yield
        finally:
            for place in places:
                subprocess.run(["umount", place], stderr=subprocess.DEVNULL)

    def step(self, said, command):
        """Runs a command of the shell there, as a row of a table. Ends the run where it fails."""
        start = time.monotonic()
        done = subprocess.run(["chroot", self.folder, "/bin/sh", "-e", "-c", command], env={**BARE, **PROXIES},
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace")
        print(f"{said:<32} {time.monotonic() - start:8.1f} {done.returncode:4}", flush=True)
        if done.returncode != 0:
            raise SystemExit(f"{said} failed:\n{done.stdout[-6000:]}{done.stderr[-2000:]}")


def table_head():
    print(f"{'step':<32} {'seconds':>8} {'rc':>4}", flush=True)
