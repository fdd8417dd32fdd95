"""Images of containers, built by buildah without a registry: debian:12-slim is a bare Debian 12 that debootstrap made."""
import json
import os
import shutil
from pathlib import Path

from host_trial import run

BASE = "docker.io/library/debian:12-slim"


def missing_for_images(root, *tools):
    """Why none can be built here; empty where one can. `root` is the bare system, made where it does not exist."""
    if os.geteuid() != 0:
        return "it needs root, for namespaces and chroot"
    absent = [name for name in ("buildah", *tools, *([] if root and root.exists() else ["debootstrap"])) if not shutil.which(name)]
    return f"{', '.join(absent)}: not installed" if absent else ""


def megabytes(folder):
    return int(run("du", "-sm", folder).split()[0])


class Images:
    """buildah with a storage of its own."""

    def __init__(self, folder, tag):
        self.tag = tag
        self.command = ["buildah", "--root", folder / "store", "--runroot", folder / "run", "--storage-driver", "vfs"]

    def __call__(self, *words):
        return run(*self.command, *words, env={**os.environ, "BUILDAH_ISOLATION": "chroot"}).strip()

    def import_root(self, root):
        container = self("from", "scratch")
        self("add", "--quiet", container, root, "/")
        self("commit", "--quiet", container, BASE)
        self("rm", container)

    def build(self, folder, *options):
        """The configuration of what the Containerfile of a folder builds, or that of --file."""
        self("build", "--pull=never", "--isolation", "chroot", "--tag", self.tag, *options, folder)
        return json.loads(self("inspect", "--type", "image", self.tag))["OCIv1"]["config"]

    def container(self):
        return self("from", "--pull=never", self.tag)

    def mounted(self):
        return Path(self("mount", self.container()))
