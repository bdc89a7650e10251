"""Codes of G-code: groups that exclude each other, the words that belong to a code, codes that do not affect a path."""

from __future__ import annotations

import math

# A line may have one code of each group.
GROUPS = {
    "motion": ("G0", "G1", "G2", "G3", "G5", "G5.1", "G5.2", "G5.3", "G6.2", "G73", "G81", "G82", "G83", "G85", "G89"),
    "plane": ("G17", "G18", "G19"),
    "units": ("G20", "G21"),
    "distances": ("G90", "G91"),
    "distances of centres": ("G90.1", "G91.1"),
    "feed": ("G93", "G94"),
    "retraction": ("G98", "G99"),
    "diameters": ("G7", "G8"),
    "coordinates": ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"),
}
GROUP_OF = {code: group for group, codes in GROUPS.items() for code in codes}
# The words of drilling cycles, besides those of axes.
CYCLES = {"G73": "RLQ", "G81": "RL", "G82": "RLP", "G83": "RLQ", "G85": "RL", "G89": "RLP"}
# Codes without an effect, with their words: corner rounding of a controller, or functions unknown to a path.
NOTHING = {"G40": "D", "G49": "", "G61": "", "G61.1": "", "G64": "PQR", "G97": "", "G50": "", "G69": "", "G15": ""}
# Those of NOTHING that set coordinates in a dialect if axes are in the same line.
WITHOUT_AXES = ("G15", "G50", "G69")
# Reported as left out, with their words: tool length (the path is that of the tip), spindle speeds, dwells.
LEFT_OUT = {"G43": "", "G96": "", "G4": "P"}
AXES = "XYZ"
ENDS = ("M2", "M30", "M98", "M99")
# The G codes of Marlin whose words all have a number.
WITHOUT_FLAGS = {*GROUP_OF, *NOTHING, *LEFT_OUT, "G52", "G53", "G92"}
# The words of a line that belong to a code and are left out with it, if it is left out by name.
WORDS_OF = {
    "G10": "LPQRXYZABCIJ",
    "G28": AXES,
    "G30": AXES,
    "G28.1": "",
    "G30.1": "",
    "G41": "D",
    "G42": "D",
    "G41.1": "DL",
    "G42.1": "DL",
    "G43.1": AXES,
    "G43.2": "H" + AXES,
    "G43.4": "H",
    "G52": AXES,
    "G53": AXES,
    "G92": AXES + "ABCEUVW",
    "G92.1": "",
    "G92.2": "",
    "G92.3": "",
    "G68": AXES + "R",
    "G51": AXES + "IJKP",
    "G95": "",
    "M98": "PLQ",
    "M99": "P",
}
# The words of M codes; axes in the same line belong to a motion.
M_WORDS = {
    "M0": "", "M1": "", "M3": "$", "M4": "$", "M5": "$", "M6": "", "M7": "", "M8": "", "M9": "", "M19": "RQP$",
    "M48": "P", "M49": "P", "M50": "P", "M51": "P$", "M52": "P", "M53": "P", "M60": "", "M61": "Q", "M62": "P",
    "M63": "P", "M64": "P", "M65": "P", "M66": "PELQ", "M67": "EQ", "M68": "EQ",
}  # fmt: skip
WHY_NOT = {
    "A": "no rotary axis is known",
    "B": "no rotary axis is known",
    "C": "no rotary axis is known",
    "U": "only X, Y and Z are known",
    "V": "only X, Y and Z are known",
    "W": "only X, Y and Z are known",
    "G41": "a radius of the tool is not known",
    "G42": "a radius of the tool is not known",
    "G41.1": "compensation of a radius is not known",
    "G42.1": "compensation of a radius is not known",
    "G33": "it follows a spindle",
    "G33.1": "it follows a spindle",
    "G76": "it follows a spindle",
    "G84": "it follows a spindle",
    "G74": "it follows a spindle",
    "G95": "the feed per turn follows a spindle",
    "G38.2": "where a probe is touched is known to the machine only",
    "G38.3": "where a probe is touched is known to the machine only",
    "G38.4": "where a probe is touched is known to the machine only",
    "G38.5": "where a probe is touched is known to the machine only",
    "G43.1": "it moves the tool by a length in the program",
    "G43.2": "it moves the tool by a length in the program",
    "G68": "turned coordinates are not known",
    "G51": "scaled coordinates are not known",
}


def code_name(letter: str, number: float) -> str:
    """Returns the name of a code: G1 for G01 and G1.0."""
    return f"{letter}{number:g}"


def program_name(number: float) -> str:
    """Returns the name of a program without leading zeros: 10 for O0010."""
    return str(int(number)) if math.isfinite(number) and number == int(number) else repr(number)


def refused(word: str) -> str:
    """Returns the error sentence for a word that is not read, with the option that leaves it out."""
    why = f": {WHY_NOT[word]}" if word in WHY_NOT else ""
    return f"{word} is not read{why} ({hint(word)})"


def refused_in_cycle(word: str, cycle: str, dialect: str) -> str:
    repeats = "; L is the number of repeats, K in the dialect fanuc" if word == "K" else ""
    return f"{word} is not read with {cycle} in the dialect {dialect}{repeats} ({hint(word)})"


def hint(word: str) -> str:
    return f"--leave-out {word} leaves it out"


def words_of(code: str, dialect: str, has_motion: bool) -> str:
    """Returns the letters of the words that belong to a code and are left out with it. All words of the line belong to
    an unknown code, none if there is a motion in the line."""
    if code in WORDS_OF:
        return WORDS_OF[code]
    if code in LEFT_OUT:
        return LEFT_OUT[code]
    if code in M_WORDS and dialect != "marlin":
        return M_WORDS[code]
    if code[0] == "M" and dialect == "linuxcnc":
        return "PQ"
    if has_motion:
        return ""
    return "ABCDEHIJKLPQRSTUVWXYZ"
