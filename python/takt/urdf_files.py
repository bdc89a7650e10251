"""Finds the folders of the URDF files of a machine file; the engine's own description holds them as text."""

from __future__ import annotations

from pathlib import Path

import yaml

from takt.yaml_text import load


def urdf_folders(text: str, folder: Path) -> dict[str, Path]:
    """Returns the folder of the URDF file of each group with serial kinematics, by name of the group; empty if the text
    cannot be read.

    text: of the machine file.
    folder: of the machine file.
    """
    if "urdf" not in text:
        return {}
    try:
        said = load(text)
        return {
            group["name"]: (folder / _folder_of(serial["urdf"]))
            for group in said["groups"]
            if (serial := (group.get("kinematics") or {}).get("serial"))
        }
    except (yaml.YAMLError, ValueError, KeyError, TypeError, AttributeError):
        return {}


def _folder_of(urdf: str) -> Path:
    return Path() if urdf.lstrip().startswith("<") else Path(urdf).parent
