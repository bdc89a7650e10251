"""EN-38: programs and libraries that read the network are built so that faults in them are harder to use."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
import takt._core
from elftools.elf.dynamic import DynamicSection
from elftools.elf.elffile import ELFFile


def taktd() -> Path:
    found = shutil.which("taktd")
    assert found, "taktd is not on the PATH"
    return Path(found)


@pytest.mark.parametrize("name", ["taktd", "_core"])
def test_what_reads_the_network_is_hardened(name: str) -> None:
    """EN-38: anywhere in memory, no stack that can be run, tables of addresses that cannot be written, guarded
    stacks."""
    file = taktd() if name == "taktd" else Path(takt._core.__file__)
    with file.open("rb") as opened:
        elf = ELFFile(opened)
        assert elf.header.e_type == "ET_DYN"
        segments = {segment.header.p_type: segment for segment in elf.iter_segments()}
        assert not segments["PT_GNU_STACK"].header.p_flags & 1
        assert "PT_GNU_RELRO" in segments
        dynamic = elf.get_section_by_name(".dynamic")
        assert isinstance(dynamic, DynamicSection)
        now = [tag for tag in dynamic.iter_tags() if tag.entry.d_tag == "DT_BIND_NOW"]
        flags = {tag.entry.d_tag: tag.entry.d_val for tag in dynamic.iter_tags() if "FLAGS" in str(tag.entry.d_tag)}
        assert now or flags.get("DT_FLAGS", 0) & 8 or flags.get("DT_FLAGS_1", 0) & 1
        assert any(symbol.name == "__stack_chk_fail" for symbol in elf.get_section_by_name(".dynsym").iter_symbols())
