"""The certificate that is made on request."""

from __future__ import annotations

import ssl
import stat
import urllib.request
from datetime import UTC, datetime, timedelta
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from mintpilot.assembly.talk import Talk
from mintpilot.cli.main import main
from mintpilot.console import Address, WebConsole
from mintpilot.console.self_signed import VALID_DAYS, self_signed
from mintpilot.core.errors import InputError


def test_the_page_is_served_with_it_and_the_key_is_for_its_owner(tmp_path: Path) -> None:
    pair = self_signed(tmp_path / "tls", "127.0.0.1")
    assert stat.S_IMODE(pair.key.stat().st_mode) == 0o600
    talk = Talk()
    address = Address(tls_cert=pair.cert, tls_key=pair.key)
    with WebConsole(understand=talk.understand, order_of=talk.order_of, address=address) as console:
        url = urlsplit(console.url())
        trusting = ssl.create_default_context(cafile=str(pair.cert))
        page = urllib.request.urlopen(f"https://{url.netloc}/", context=trusting, timeout=10)
        assert b"MintPilot" in page.read()
        with pytest.raises(OSError, match="CERTIFICATE_VERIFY_FAILED"):
            urllib.request.urlopen(f"https://{url.netloc}/", context=ssl.create_default_context(), timeout=10)
        der = ssl.PEM_cert_to_DER_cert(ssl.get_server_certificate((url.hostname or "", url.port or 0)))
        import hashlib

        assert pair.fingerprint.replace(":", "").lower() == hashlib.sha256(der).hexdigest()


def test_it_is_used_again_while_it_is_valid_and_names_the_host(tmp_path: Path) -> None:
    first = self_signed(tmp_path, "drone.local")
    assert self_signed(tmp_path, "drone.local") == first
    assert self_signed(tmp_path, "192.168.1.5").fingerprint != first.fingerprint
    later = datetime.now(UTC) + timedelta(days=VALID_DAYS)
    other = self_signed(tmp_path, "192.168.1.5")
    assert self_signed(tmp_path, "192.168.1.5", now=later).fingerprint != other.fingerprint
    other.key.write_text("no key")
    assert self_signed(tmp_path, "192.168.1.5").key.read_text().startswith("-----BEGIN PRIVATE KEY")


def test_a_folder_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="give a folder"):
        self_signed(tmp_path / "file", "localhost")


def test_it_goes_with_the_page_and_without_a_pair(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "x.yaml", "--operator", "terminal", "--tls-self-signed", str(tmp_path)]) == 2
    assert "--operator console only" in capsys.readouterr().err
    both = ["--tls-self-signed", str(tmp_path), "--tls-cert", "a.pem"]
    assert main(["run", "x.yaml", "--operator", "console", *both]) == 2
    assert "leave out" in capsys.readouterr().err
