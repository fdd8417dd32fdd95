"""Makes whole sets of cases: the cases in one tree, their labels in one key file outside of it."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
import signal
import sys
import warnings
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path

from trials.generator.case import Case, Specification, build, write
from trials.generator.strata import seed_of
from trials.generator.unreachable import Unreachable
from trials.progress import Progress


def finish_what_is_begun() -> None:
    """In a worker: a signal to all processes of the terminal is the first one's to answer, which then begins no case more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)


def case_name(seed: str, number: int) -> str:
    """A name that tells nothing: twelve digits of a hash."""
    return f"{seed_of(f'name of case {number} of {seed}'):016x}"[:12]


DRAWS = 10
"""So often a case is drawn anew that cannot be had as it was drawn."""


def drawn(specification: Specification) -> Case:
    """A case as it is specified. Where a loop swallows what should dominate, all that is drawn for it is drawn once more;
    its label tells the seed that served. Raises Unreachable where no draw does."""
    for number in range(1, DRAWS):
        try:
            return build(specification)
        except Unreachable:
            specification = replace(specification, seed=seed_of(f"draw {number} after {specification.seed}"))
    return build(specification)


def make_one(specification: Specification, folder: str, label_file: str) -> None:
    """Builds and writes one case; its label appears only once the case is whole."""
    warnings.simplefilter("error", RuntimeWarning)
    case = drawn(specification)
    scratch = Path(folder + ".part")
    for left_over in (scratch, Path(folder)):
        shutil.rmtree(left_over, ignore_errors=True)
    write(case, scratch)
    scratch.rename(folder)
    Path(label_file + ".part").write_text(json.dumps(case.label))
    os.replace(label_file + ".part", label_file)


def fingerprint(specifications: list[Specification]) -> str:
    """SHA-256 of a plan: sets of one seed differ in sizes, lengths and ratios."""
    return hashlib.sha256(repr(specifications).encode()).hexdigest()


class OtherSet(Exception):
    """A key, or the labels of a set that was interrupted, are of another plan, or the key is sealed."""


def is_made(key: Path, plan: str) -> bool:
    """Whether this set is there already. Raises OtherSet where the key, or what is begun of it, is of another one,
    or the key is sealed."""
    sealed = next((key.with_suffix(end) for end in (".sealed", ".sha256") if key.with_suffix(end).exists()), None)
    if sealed:
        raise OtherSet(f"{sealed} is there: the key of this name is sealed, and an open one beside it would give it away")
    begun = key.with_suffix(".labels") / "plan.sha256"
    try:
        other = json.loads(key.read_text()).get("plan") if key.exists() else begun.read_text() if begun.exists() else plan
    except (ValueError, AttributeError):
        other = None
    if other != plan:
        raise OtherSet(f"{key if key.exists() else begun.parent} is of another set, or of another generator")
    return key.exists()


def make_set(seed: str, specifications: list[Specification], cases: Path, key: Path, jobs: int, quiet: bool = False) -> int:
    """Makes what is missing of a set, then joins the labels into the key. Returns the number of cases. Raises OtherSet."""
    plan = fingerprint(specifications)
    names = [case_name(seed, number) for number in range(len(specifications))]
    labels = key.with_suffix(".labels")
    if is_made(key, plan) and all((cases / name).is_dir() for name in names):
        return len(names)
    strange = {one.name.removesuffix(".part") for one in cases.iterdir()} - set(names) if cases.is_dir() else set()
    if strange:
        raise OtherSet(f"{cases} holds {min(strange)}, which is no case of this set")
    cases.mkdir(parents=True, exist_ok=True, mode=0o700)  # a product that runs as another user sees its own case alone
    try:
        labels.mkdir(parents=True, exist_ok=True, mode=0o700)
        (labels / "plan.sha256").write_text(plan)
    except OSError:
        with contextlib.suppress(OSError):
            cases.rmdir()  # what was begun here and holds nothing
        raise
    missing = [i for i, name in enumerate(names) if not (labels / f"{name}.json").exists() or not (cases / name).is_dir()]
    progress = Progress("generate", len(names), len(names) - len(missing), quiet)
    with ProcessPoolExecutor(jobs, initializer=finish_what_is_begun) as pool:
        futures = [
            pool.submit(make_one, specifications[i], str(cases / names[i]), str(labels / f"{names[i]}.json")) for i in missing
        ]
        for i, future in zip(missing, futures):
            try:
                future.result()
            except KeyboardInterrupt:
                pool.shutdown(cancel_futures=True)
                raise
            except Exception as error:
                print(f"{names[i]}: {specifications[i]}: {error!r}", file=sys.stderr)
                pool.shutdown(cancel_futures=True)
                raise
            progress.step()
    merged = {name: json.loads((labels / f"{name}.json").read_text()) for name in sorted(names)}
    text = json.dumps({"schema": "hysteron-trial-key/1", "seed": seed, "plan": plan, "cases": merged}, indent=1)
    scratch = key.with_suffix(".part")
    scratch.touch(mode=0o600)
    scratch.write_text(text)
    os.replace(scratch, key)
    for file in labels.iterdir():
        file.unlink()
    labels.rmdir()
    return len(names)
