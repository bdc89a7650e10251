"""EN-35: what the engine computes is the same bits on every x86-64 processor."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from takt import _core

BUILD = Path(os.environ.get("TAKT_BUILD_DIR", "build/release"))
RUNS = Path(__file__).parent / "processor_runs.py"
BINARIES = {"taktd": BUILD / "bin/taktd", "_core": Path(_core.__file__)}

# Without what a processor may lack, the C library chooses as it does there.
PROCESSORS = ("-AVX2", "-FMA,-FMA4", "-AVX2,-FMA,-FMA4,-AVX,-SSE4_1", "-AVX512F,-AVX512VL")

# Functions of libm whose result IEEE 754 prescribes to the last bit.
EXACT = set(
    "ceil copysign fabs floor fma fmax fmin fmod frexp ldexp llrint llround lrint lround modf nearbyint nextafter "
    "remainder rint round scalbn sqrt trunc".split()
)
# Parts of mangled names of KDL's that ask libm for sine, cosine or arc tangent.
OF_KDL = ("Rotation3Rot", "Rotation4Rot2", "3RPY", "GetRot", "GetRPY", "Euler", "Frame2DH", "5Joint", "5Chain")

# A C library whose functions are wrong from the twelfth digit on.
WRONG = """
#define _GNU_SOURCE
#include <dlfcn.h>
#define ONE(name) double name(double x) { \\
  static double (*of)(double); if (!of) of = (double (*)(double))dlsym(RTLD_NEXT, #name); \\
  return of(x) * (1 + 0x1p-40); }
#define TWO(name) double name(double x, double y) { \\
  static double (*of)(double, double); if (!of) of = (double (*)(double, double))dlsym(RTLD_NEXT, #name); \\
  return of(x, y) * (1 + 0x1p-40); }
ONE(sin) ONE(cos) ONE(tan) ONE(asin) ONE(acos) ONE(atan) ONE(sinh) ONE(cosh) ONE(tanh) ONE(asinh) ONE(acosh)
ONE(atanh) ONE(exp) ONE(exp2) ONE(expm1) ONE(log) ONE(log2) ONE(log10) ONE(log1p) ONE(cbrt) ONE(erf) ONE(erfc)
TWO(atan2) TWO(pow) TWO(hypot)
void sincos(double x, double* s, double* c) { *s = sin(x); *c = cos(x); }
"""


def runs(**environment: str) -> dict[str, str]:
    """Digests of all runs, by name."""
    command = [sys.executable, "-W", "ignore", str(RUNS)]
    done = subprocess.run(command, env={**os.environ, **environment}, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    return dict(json.loads(done.stdout))


@pytest.fixture(scope="module")
def here() -> dict[str, str]:
    return runs()


@pytest.mark.parametrize("without", PROCESSORS)
def test_runs_are_the_same_on_every_processor(here: dict[str, str], without: str) -> None:
    there = runs(GLIBC_TUNABLES=f"glibc.cpu.hwcaps={without}")
    del there["c_library"]  # differs where the processor has what it is told to do without
    assert {name: here[name] for name in there} == there


def test_runs_ask_no_function_of_the_c_library(here: dict[str, str], tmp_path: Path) -> None:
    """Not through the libraries either that the engine is linked with: with wrong functions the runs are the same."""
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    source, library = tmp_path / "wrong.c", tmp_path / "wrong.so"
    source.write_text(WRONG)
    subprocess.run([compiler, "-O1", "-fno-builtin", "-shared", "-fPIC", "-o", library, source], check=True)
    there = runs(LD_PRELOAD=str(library))
    assert there.pop("c_library") != here["c_library"]
    assert {name: here[name] for name in there} == there


def undefined(binary: Path) -> set[str]:
    listed = subprocess.run(["nm", "-D", "--undefined-only", binary], check=True, capture_output=True, text=True).stdout
    return {line.split()[-1].partition("@")[0] for line in listed.splitlines()}


@pytest.mark.parametrize("name", BINARIES)
def test_the_engine_imports_no_function_that_the_c_library_chooses(name: str) -> None:
    """What no run above comes past, too."""
    if shutil.which("nm") is None:
        pytest.skip("no nm")
    listed = subprocess.run(["ldd", BINARIES["taktd"]], check=True, capture_output=True, text=True).stdout
    libm = next(line.split()[2] for line in listed.splitlines() if line.split()[0].startswith("libm."))
    defined = subprocess.run(["nm", "-D", "--defined-only", libm], check=True, capture_output=True, text=True).stdout
    of_libm = {line.split()[-1].partition("@")[0] for line in defined.splitlines()}
    assert {"sin", "pow", "floor"} <= of_libm
    imported = undefined(BINARIES[name])
    assert sorted(imported & of_libm - EXACT) == []
    assert [symbol for symbol in sorted(imported) if "KDL" in symbol and any(part in symbol for part in OF_KDL)] == []
