"""auditwheel with a shorter list of libraries that a wheel may leave to the host: the C runtime alone.

Its own list has GLib, which liblcm needs and a host without a desktop does not have.

    python -m tools.repair_wheel repair --wheel-dir build/wheelhouse build/dist/*.whl
"""

import json
import tempfile
from pathlib import Path

from auditwheel import policy
from auditwheel.libc import Libc
from auditwheel.main import main

LEFT_TO_THE_HOST = {
    "libgcc_s.so.1", "libstdc++.so.6", "libm.so.6", "libdl.so.2", "librt.so.1", "libc.so.6", "libnsl.so.1",
    "libutil.so.1", "libpthread.so.0", "libresolv.so.2", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1",
}  # fmt: skip


def shorten_lists(into: Path) -> None:
    """Has auditwheel read its policies with the lists of libraries shortened."""
    policies = json.loads(policy._POLICY_JSON_MAP[Libc.GLIBC].read_text())
    for one in policies:
        one["lib_whitelist"] = [name for name in one["lib_whitelist"] if name in LEFT_TO_THE_HOST]
    into.write_text(json.dumps(policies))
    policy._POLICY_JSON_MAP[Libc.GLIBC] = into


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        shorten_lists(Path(folder) / "policies.json")
        raise SystemExit(main())
