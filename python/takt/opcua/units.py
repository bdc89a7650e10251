"""Units in OPC UA: EUInformation with the common codes of UNECE recommendation 20 (OPC 10000-8, 5.6.3)."""

from __future__ import annotations

from asyncua import ua

UNECE = "http://www.opcfoundation.org/UA/units/un/cefact"
# Common code and name by Takt's unit; other units have the number -1 and only their text.
CODES = {
    "1": ("C62", "one"),
    "%": ("P1", "percent"),
    "um": ("4H", "micrometre (micron)"),
    "mm": ("MMT", "millimetre"),
    "cm": ("CMT", "centimetre"),
    "m": ("MTR", "metre"),
    "in": ("INH", "inch"),
    "mm/s": ("C16", "millimetre per second"),
    "m/s": ("MTS", "metre per second"),
    "mm/s²": ("M41", "millimetre per second squared"),
    "m/s²": ("MSK", "metre per second squared"),
    "deg": ("DD", "degree [unit of angle]"),
    "deg/s": ("E96", "degree per second"),
    "deg/s²": ("M45", "degree [unit of angle] per second squared"),
    "rad": ("C81", "radian"),
    "rad/s": ("2A", "radian per second"),
    "rad/s²": ("2B", "radian per second squared"),
    "rev": ("M44", "revolution"),
    "rev/s": ("RPS", "revolutions per second"),
    "1/s": ("C97", "reciprocal second"),
    "1/min": ("C94", "reciprocal minute"),
    "s": ("SEC", "second [unit of time]"),
    "ms": ("C26", "millisecond"),
    "ns": ("C47", "nanosecond"),
    "V": ("VLT", "volt"),
    "A": ("AMP", "ampere"),
    "N": ("NEW", "newton"),
    "Nm": ("NU", "newton metre"),
}


def number_of(code: str) -> int:
    """Returns the OPC UA number of a common code: the code's characters are the bytes of the number."""
    return int.from_bytes(code.encode("ascii"), "big")


def unit(text: str) -> ua.EUInformation:
    code, name = CODES.get(text, ("", text))
    return ua.EUInformation(
        NamespaceUri=UNECE if code else "urn:takt:units",
        UnitId=number_of(code) if code else -1,
        DisplayName=ua.LocalizedText(text.replace("deg", "°")),
        Description=ua.LocalizedText(name),
    )
