"""A self-signed certificate for the page, made on request: what is said is encrypted, who serves can be compared."""

from __future__ import annotations

import ipaddress
import os
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Final

from mintpilot.core.errors import InputError, MissingPartError

CERT_FILE, KEY_FILE = "mintpilot-cert.pem", "mintpilot-key.pem"
VALID_DAYS: Final = 90
"""Browsers keep an exception for a certificate, so it is used again until then."""
_RENEWED: Final = timedelta(days=1)


@dataclass(frozen=True, slots=True, kw_only=True)
class Pair:
    """A certificate and its key."""

    cert: Path
    key: Path
    fingerprint: str
    """SHA-256 of the certificate, as browsers show it: whoever opens the page compares it."""


def self_signed(folder: Path, host: str, *, now: datetime | None = None) -> Pair:
    """The pair in that folder; made where there is none for this host that is still valid. The key is for its owner.

    Args:
        folder: made where it does not exist.
        host: name or address under which browsers open the page.
        now: default: the present time.

    Raises:
        MissingPartError: the library that makes certificates is not installed.
        InputError: the folder cannot be written.
    """
    try:
        from cryptography import x509
        from cryptography.hazmat.primitives import hashes, serialization
        from cryptography.hazmat.primitives.asymmetric import ec
        from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID
    except ImportError as error:
        raise MissingPartError("--tls-self-signed needs 'cryptography': pip install 'mintpilot[console]'") from error
    now = now or datetime.now(UTC)
    cert_file, key_file = folder / CERT_FILE, folder / KEY_FILE
    try:
        named: x509.GeneralName = x509.IPAddress(ipaddress.ip_address(host))
    except ValueError:
        named = x509.DNSName(host)
    try:
        known = x509.load_pem_x509_certificate(cert_file.read_bytes())
        key = serialization.load_pem_private_key(key_file.read_bytes(), password=None)
        names = known.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
        fits = named in names and known.not_valid_after_utc > now + _RENEWED and known.not_valid_before_utc <= now
        if fits and key.public_key() == known.public_key():
            return Pair(cert=cert_file, key=key_file, fingerprint=_shown(known.fingerprint(hashes.SHA256())))
    except (OSError, ValueError, TypeError, x509.ExtensionNotFound):
        pass  # there is none, or it is none: it is made
    made = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "MintPilot console")])
    local: list[x509.GeneralName] = [x509.DNSName("localhost"), x509.IPAddress(ipaddress.ip_address("127.0.0.1"))]
    cert = (
        x509.CertificateBuilder()
        .subject_name(name)
        .issuer_name(name)
        .public_key(made.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - timedelta(hours=1))
        .not_valid_after(now + timedelta(days=VALID_DAYS))
        .add_extension(x509.SubjectAlternativeName(list(dict.fromkeys([named, *local]))), critical=False)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH]), critical=False)
        .sign(made, hashes.SHA256())
    )
    secret = made.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    try:
        folder.mkdir(parents=True, exist_ok=True)
        key_file.unlink(missing_ok=True)
        opened = os.open(key_file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(opened, "wb") as file:
            file.write(secret)
        cert_file.write_bytes(cert.public_bytes(serialization.Encoding.PEM))
    except OSError as error:
        raise InputError(f"--tls-self-signed {folder}: {error.strerror}; give a folder that you may write") from error
    return Pair(cert=cert_file, key=key_file, fingerprint=_shown(cert.fingerprint(hashes.SHA256())))


def _shown(digest: bytes) -> str:
    return ":".join(f"{byte:02X}" for byte in digest)
