"""EN-11: the reference page is made from the descriptions and leaves nothing out."""

from __future__ import annotations

import json

from takt import _core
from takt.cli import main
from takt.reference import reference_page


def test_everything_described_is_on_the_page() -> None:
    reference = json.loads(_core.reference())
    page = reference_page()
    for verb in reference["verbs"]:
        assert f"### {verb['target_kind']}: {verb['name']}\n" in page
        for field in verb["arguments"]["fields"]:
            assert f"| {field['name']} | " in page
            assert field["about"] in page
    for published in (*reference["outputs"].values(), reference["figures"]):
        for field in published["fields"]:
            assert f"| {field['name']} | " in page
            assert field["about"] in page
    assert [line for line in page.splitlines() if line in ("### axis", "### flex_cam", "### engine")] == [
        "### axis",
        "### flex_cam",
        "### engine",
    ]
    for error in reference["errors"]:
        assert f"| {error['id']:04} | {error['name']} | {error['text']} |" in page
    for row in reference["homing"]["rows"]:
        to = "[*]" if row["to"] == "none" else row["to"]
        assert f"  {row['from']} --> {to}: {row['event']} / {row['action']}" in page
    assert "  returning --> waiting: stopped / pause (switches)\n" in page
    assert "| position | real | u |  | required | Target position." in page
    assert "| period_s | real | s | from 0.00025 to 0.02 | 0.001 |" in page
    assert "  Standstill --> DiscreteMotion: " in page


def test_command_line() -> None:
    assert main(["reference"]) == 0
