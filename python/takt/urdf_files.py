"""Where the URDF files of a machine file are, which the engine's description of the machine holds as text."""

from __future__ import annotations

from pathlib import Path

import yaml

from takt.yaml_text import load


def urdf_folders(text: str, folder: Path) -> dict[str, Path]:
    """The folder of the URDF of each group whose kinematics are in one. `folder`: of the machine file, whose text this
    is."""
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
