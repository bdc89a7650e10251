"""Models generated from the kinematics of a machine file: MJCF, in m, kg and degrees.

Each axis moves one body with the mass given in the section `twin`; shapes serve for inertia, contact and pictures. A
Delta is a closed chain: six rods on ball joints between its arms and a platform that only the rods hold.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any
from xml.sax.saxutils import quoteattr

MECHANISMS = ("gantry", "core_xy", "scara", "delta", "six_axis", "serial")
ROD_SPACING = 60.0  # [mm] default rod spacing of a Delta
ENVIRONMENT = 1 << 30  # contact group of obstacles; each mechanism has its own group
PRODUCTS = 1 << 29  # contact group of products
GROUPS = 29
PARK_M = (0.0, 50.0, 0.0)  # [m] position of the first parked product
PARK_STEP_M = 1.0  # distance between parked products
UNSEEN = 'rgba="0 0 0 0" contype="0" conaffinity="0"'  # shapes that only have mass
SEEN = 'contype="0" conaffinity="0"'  # shapes that are only visible
TIP = 1.0  # [mm] distance between a cup and the body from which it hangs
SLIDES = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
TURNS = {"a": (1, 0, 0), "b": (0, 1, 0), "c": (0, 0, 1)}


@dataclass(frozen=True)
class Body:
    """The body that an axis of a generated mechanism moves, in the frame of the body of the preceding axis."""

    axis: str
    direction: tuple[float, float, float]
    slides: bool
    at: tuple[float, float, float] = (0.0, 0.0, 0.0)  # [mm]
    to: tuple[float, float, float] = (0.0, 0.0, 0.0)  # [mm] end of its shape


@dataclass
class Made:
    """Parts of an MJCF."""

    world: list[str] = field(default_factory=list)
    equality: list[str] = field(default_factory=list)
    contact: list[str] = field(default_factory=list)
    solids: list[str] = field(default_factory=list)  # shapes of mechanisms, checked for contact with belts
    joints: dict[str, str] = field(default_factory=dict)  # by axis
    tools: dict[str, str] = field(default_factory=dict)  # by group: site


def mechanism_of(group: Mapping[str, Any]) -> tuple[str, dict[str, Any]]:
    """Returns kind and parameters of a group's kinematics."""
    kinematics = group["kinematics"]
    kind = next(kind for kind in MECHANISMS if kinematics.get(kind) is not None)
    return kind, kinematics[kind]


def document(name: str, made: Made, step_s: float) -> str:
    """Returns the model as one MJCF document. step_s: time step of the physics [s]."""
    return f"""<mujoco model={quoteattr(name)}>
<compiler angle="degree" eulerseq="XYZ" autolimits="true"/>
<option timestep="{step_s!r}" integrator="implicitfast" gravity="0 0 -9.81"/>
<visual><global offwidth="1280" offheight="720"/><headlight ambient=".4 .4 .4" diffuse=".5 .5 .5"/></visual>
<asset><texture type="skybox" builtin="gradient" rgb1=".96 .97 .98" rgb2=".8 .83 .88" width="64" height="384"/></asset>
<default><equality solref="0.001 1" solimp="0.99 0.9999 0.0001"/></default>
<worldbody><light pos="0 -1 2.5" diffuse=".7 .7 .7"/>
{"".join(made.world)}</worldbody>
<equality>{"".join(made.equality)}</equality>
<contact>{"".join(made.contact)}</contact>
</mujoco>"""


def add_group(made: Made, number: int, group: Mapping[str, Any], twin: Mapping[str, Any]) -> None:
    """Adds the mechanism of a group; not for kinematics from a URDF. number: index of the group, for its contacts."""
    kind, params = mechanism_of(group)
    axes = {axis["axis"]: axis for axis in twin["axes"]}
    told: Mapping[str, Any] = next((one for one in twin["mechanisms"] if one["group"] == group["name"]), {})
    if kind == "delta":
        inside = _delta(made, number, group, params, axes, told)
    else:
        inside = _chain(made, number, group, _bodies(kind, group["axes"], params), axes, told)
    obstacles = "".join(_obstacle(solid) for solid in ((group.get("workspace") or {}).get("obstacles") or ()))
    made.world.append(f"<body {_pose(group['base'])}>{inside}{obstacles}</body>\n")


def belt(name: str) -> str:
    """Returns the name of body and shape of a belt."""
    return f"belt {name}"


def product(slot: int) -> str:
    """Returns the name of body, joint and shape of a product."""
    return f"product {slot + 1}"


def grip(group: str, slot: int) -> str:
    """Returns the name of the weld by which a gripper holds a product."""
    return f"{group} holds {slot + 1}"


def add_belt(made: Made, told: Mapping[str, Any], params: Mapping[str, Any], axis: Mapping[str, Any]) -> None:
    """Adds a belt: a plate whose body is moved along X by its axis. Its shape is moved back every few cycles
    (takt.twin.cargo), so that the plate stays and its surface moves. Contacts are explicit pairs, since MuJoCo's own
    search for contacts uses the position of the body."""
    name, thick = belt(told["belt"]), 10.0  # mm
    length = (told["to"] - told["from"]) / 2000
    at = _metres(((told["from"] + told["to"]) / 2, 0, told["surface"] - thick / 2))
    made.world.append(
        f"<body name={quoteattr(name)} {_pose(params['origin'])}>{_joint(made, axis, (1, 0, 0), True)}"
        f'<geom name={quoteattr(name)} type="box" size="{length!r} {told["width"] / 2000!r} {thick / 2000!r}"'
        f' pos="{at}" mass="{axis["mass"]!r}" rgba=".35 .4 .45 1" contype="0" conaffinity="0"/></body>\n'
    )
    for solid in made.solids:
        made.contact.append(f"<pair geom1={quoteattr(name)} geom2={quoteattr(solid)}/>")


def add_products(made: Made, told: Mapping[str, Any], belts: Sequence[Mapping[str, Any]]) -> None:
    """Adds the products, parked beside the machine, and their contacts with belts."""
    size = " ".join(repr(told[edge] / 2000) for edge in ("length", "width", "height"))
    contacts = f'contype="{PRODUCTS}" conaffinity="{(1 << GROUPS) - 1 | PRODUCTS | ENVIRONMENT}"'
    for slot in range(told["count"]):
        name = quoteattr(product(slot))
        x, y, z = PARK_M[0] + PARK_STEP_M * slot, PARK_M[1], PARK_M[2]
        made.world.append(
            f'<body name={name} pos="{x!r} {y!r} {z!r}"><freejoint name={name}/><geom name={name} type="box"'
            f' size="{size}" mass="{told["mass"]!r}" friction="{told["friction"]!r} 0.005 0.0001"'
            f' rgba=".95 .65 .15 1" {contacts}/></body>\n'
        )
        for one in belts:
            f = one["friction"]
            made.contact.append(
                f'<pair geom1={quoteattr(belt(one["belt"]))} geom2={name} friction="{f!r} {f!r} 0.005 0.0001 0.0001"'
                f' solref="0.005 1" solimp="0.99 0.99 0.001"/>'
            )


def add_gripper(made: Made, group: Mapping[str, Any], count: int) -> None:
    """Adds the welds by which the gripper of a group holds products, disabled."""
    kind, params = mechanism_of(group)
    name = group["name"]
    body = f"{name}.platform" if kind == "delta" and not params["rotary"] else _last(group, kind)
    for slot in range(count):
        made.equality.append(
            f"<weld name={quoteattr(grip(name, slot))} body1={quoteattr(body)} body2={quoteattr(product(slot))}"
            ' active="false" solref="0.002 1"/>'
        )


def _last(group: Mapping[str, Any], kind: str) -> str:
    """Returns the name of the axis that moves the tool's body."""
    if kind == "delta":
        return str(group["axes"][3])
    return _bodies(kind, group["axes"], mechanism_of(group)[1])[-1].axis


def _cup(made: Made, group: Mapping[str, Any], told: Mapping[str, Any]) -> str:
    """Returns the cup of a gripper, above the TCP. It collides with obstacles and belts, not with products."""
    tool, gripper = group["tool"], told["gripper"]
    back = -1 if mechanism_of(group)[0] == "six_axis" else 1  # its flange points along Z, all others against Z
    at = _metres((tool["x"], tool["y"], tool["z"] + back * gripper["length"] / 2))
    name = f"{group['name']}.gripper"
    made.solids.append(name)
    load = ""
    if payload := told.get("payload", 0):
        point = _metres((tool["x"], tool["y"], tool["z"]))
        load = f'<geom type="sphere" size="0.015" pos="{point}" mass="{payload!r}" {UNSEEN}/>'
    return load + (
        f'<geom name={quoteattr(name)} type="cylinder" size="{gripper["radius"] / 1000!r} {gripper["length"] / 2000!r}"'
        f' pos="{at}" mass="0" rgba=".9 .6 .1 1" contype="0" conaffinity="{ENVIRONMENT}"/>'
    )


def add_alone(made: Made, number: int, place: int, axis: Mapping[str, Any], rotary: bool) -> None:
    """Adds an axis that no mechanism uses. place: index among these axes, for its position in the world."""
    direction = axis.get("direction") or ("z" if rotary else "x")
    joint = _joint(made, axis, SLIDES[direction], not rotary)
    if rotary:
        radius = axis["radius"] / 1000
        ends = " ".join(f"{0.01 * n:g} " for n in SLIDES[direction])
        minus = " ".join(f"{-0.01 * n:g} " for n in SLIDES[direction])
        shape = f'<geom type="cylinder" size="{radius!r}" fromto="{minus}{ends}"'
        shape += f' mass="{axis["mass"]!r}" rgba=".8 .5 .2 1" {_contacts(number)}/>'
    else:
        shape = f'<geom type="box" size=".05 .05 .03" mass="{axis["mass"]!r}" rgba=".2 .4 .8 1" {_contacts(number)}/>'
    made.world.append(f'<body pos="0 {0.4 * place:g} 0">{joint}{shape}</body>\n')


def _bodies(kind: str, axes: Sequence[str], p: Mapping[str, Any]) -> list[Body]:
    if kind == "gantry":
        moved = list(zip(axes, p["axes"], strict=False))
        slides = [Body(axis, SLIDES[c], True, to=(0, 0, -60)) for axis, c in moved if c in SLIDES]
        turns = [Body(a, TURNS[t], False, to=(0, 0, -40)) for t in "cba" for a, c in moved if c == t]
        return slides + turns
    if kind == "scara":
        first, second, height = p["first_arm"], p["second_arm"], p["height"]
        z, turn = (0.0, 0.0, 1.0), False
        return [
            Body(axes[0], z, turn, at=(0, 0, height), to=(first, 0, 0)),
            Body(axes[1], z, turn, at=(first, 0, 0), to=(second, 0, 0)),
            Body(axes[2], z, True, at=(second, 0, 0), to=(0, 0, 100)),
            Body(axes[3], z, turn, to=(0, 0, 30)),
        ]
    z, y = (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)
    return [
        Body(axes[0], z, False, to=(p["a1"], 0, p["c1"])),
        Body(axes[1], y, False, at=(p["a1"], 0, p["c1"]), to=(0, 0, p["c2"])),
        Body(axes[2], y, False, at=(0, 0, p["c2"]), to=(p["a2"], p["b"], p["c3"] / 2)),
        Body(axes[3], z, False, at=(p["a2"], p["b"], p["c3"]), to=(0, 0, -p["c3"] / 4)),
        Body(axes[4], y, False, to=(0, 0, p["c4"] / 2)),
        Body(axes[5], z, False, at=(0, 0, p["c4"]), to=(0, 0, -20)),
    ]


def _chain(
    made: Made,
    number: int,
    group: Mapping[str, Any],
    bodies: Sequence[Body],
    axes: Mapping[str, Mapping[str, Any]],
    told: Mapping[str, Any],
) -> str:
    text, ends = "", ""
    for body in bodies:
        axis = axes[body.axis]
        joint = _joint(made, axis, body.direction, body.slides)
        to = body.to if math.hypot(*body.to) > 1 else (0.0, 0.0, -30.0)
        start = (0.0, 0.0, 0.0)
        if told.get("gripper") and body.slides:
            to = (to[0], to[1], abs(to[2]))  # away from the products
        if told.get("gripper") and body is bodies[-1]:  # the cup hangs from it
            above = max(0.0, group["tool"]["z"] + told["gripper"]["length"]) + 20 + TIP
            start, to = (0.0, 0.0, above), (0.0, 0.0, above + 30)
            if mechanism_of(group)[0] == "six_axis":
                start, to = (0.0, 0.0, -above), (0.0, 0.0, -above - 30)
        shape = f'<geom name={quoteattr(body.axis)} type="capsule" size="0.02" fromto="{_metres(start)} {_metres(to)}"'
        shape += f' mass="{axis["mass"]!r}"'
        made.solids.append(body.axis)
        text += f'<body name={quoteattr(body.axis)} pos="{_metres(body.at)}">{joint}{shape} {_contacts(number)}/>'
        ends += "</body>"
    return text + _tool(made, number, group, told) + ends


def _delta(
    made: Made,
    number: int,
    group: Mapping[str, Any],
    p: Mapping[str, Any],
    axes: Mapping[str, Mapping[str, Any]],
    told: Mapping[str, Any],
) -> str:
    name, lower = group["name"], p["lower_arm"] / 1000
    half = (p["rod_spacing"] or ROD_SPACING) / 2000
    platform = p["platform_radius"] / 1000
    thick = 0.008
    # The cup of a gripper hangs from the platform, so the platform's shape is above the cup.
    height = (
        max(0.0, (group["tool"]["z"] + told["gripper"]["length"]) / 1000 + thick + TIP / 1000)
        if told.get("gripper")
        else 0.0
    )
    radius = p["base_radius"] / 1000
    arms = f'<geom type="cylinder" size="{radius!r} 0.01" pos="0 0 0.03" mass="0" rgba=".55 .6 .65 1" {SEEN}/>'
    sites = ""
    for i in range(3):
        turn = p["first_arm_deg"] + 120 * i
        cos, sin = math.cos(math.radians(turn)), math.sin(math.radians(turn))
        rods = ""
        for k, y in enumerate((-half, half)):
            end = f"{name}.rod_{i + 1}{k + 1}"
            rods += (
                f'<body name={quoteattr(end)} pos="{p["upper_arm"] / 1000!r} {y!r} 0">'
                f'<joint name={quoteattr(end)} type="ball" damping="0.0002"/>'
                f'<geom type="capsule" size="0.006" fromto="0 0 0 0 0 {-lower!r}" mass="{told["rod_mass"]!r}"'
                f' rgba=".3 .3 .3 1" {_contacts(number)}/>'
                f'<site name={quoteattr(end)} pos="0 0 {-lower!r}"/></body>'
            )
            at = f"{platform * cos - y * sin!r} {platform * sin + y * cos!r} 0"
            sites += f'<site name={quoteattr(end + ".at")} pos="{at}"/>'
            made.equality.append(f"<connect site1={quoteattr(end)} site2={quoteattr(end + '.at')}/>")
            if height:
                sites += (
                    f'<geom type="capsule" size="0.003" fromto="{at} {at[:-1]}{height!r}" mass="0"'
                    f' rgba=".8 .2 .2 1" {SEEN}/>'
                )
        axis = axes[group["axes"][i]]
        joint = _joint(made, axis, (0, 1, 0), False)
        arms += (
            f'<body euler="0 0 {turn!r}">'
            f'<body name={quoteattr(axis["axis"])} pos="{p["base_radius"] / 1000!r} 0 0">{joint}'
            f'<geom type="capsule" size="0.02" fromto="0 0 0 {p["upper_arm"] / 1000!r} 0 0" mass="{axis["mass"]!r}"'
            f' rgba=".2 .4 .8 1" {_contacts(number)}/>{rods}</body></body>'
        )
    tool = _tool(made, number, group, told)
    if p["rotary"]:
        axis = axes[group["axes"][3]]
        tool = (
            f"<body name={quoteattr(axis['axis'])}>{_joint(made, axis, (0, 0, 1), False)}"
            f'<geom type="cylinder" size="0.02 0.01" pos="0 0 {height!r}" mass="{axis["mass"]!r}" {_contacts(number)}/>'
            f"{tool}</body>"
        )
    # A child of the world, since MuJoCo allows free joints only there; takt.twin.model assembles the chain.
    body = f"{name}.platform"
    made.solids.append(body)
    disc = f'type="cylinder" size="{max(platform, 0.01)!r} {thick!r}"'
    # The mass is at the height of the rods, wherever the shape is.
    made.world.append(
        f"<body name={quoteattr(body)}><freejoint name={quoteattr(body)}/>"
        f'<geom {disc} mass="{told["platform_mass"]!r}" {UNSEEN}/>'
        f'<geom name={quoteattr(body)} {disc} pos="0 0 {height!r}" mass="0" rgba=".8 .2 .2 1" {_contacts(number)}/>'
        f"{sites}{tool}</body>\n"
    )
    return arms


def _joint(made: Made, axis: Mapping[str, Any], direction: Sequence[float], slides: bool) -> str:
    name = axis["axis"]
    made.joints[name] = name
    kind, along = "slide" if slides else "hinge", " ".join(map(str, direction))
    return f'<joint name={quoteattr(name)} type="{kind}" axis="{along}"/>'


def _tool(made: Made, number: int, group: Mapping[str, Any], told: Mapping[str, Any]) -> str:
    name = f"{group['name']}.flange"
    made.tools[group["name"]] = name
    text = f"<site name={quoteattr(name)}/>"
    if told.get("gripper"):
        return text + _cup(made, group, told)
    if payload := told.get("payload", 0):
        tool = group["tool"]
        at = _metres((tool["x"], tool["y"], tool["z"]))
        text += (
            f'<geom type="sphere" size="0.015" pos="{at}" mass="{payload!r}" rgba=".9 .6 .1 1" {_contacts(number)}/>'
        )
    return text


def _contacts(number: int) -> str:
    """Returns the contact groups of a mechanism, whose parts collide with other mechanisms, obstacles and products, but
    not with one another."""
    own = 1 << (number % GROUPS)
    return f'contype="{own}" conaffinity="{((1 << GROUPS) - 1) & ~own | ENVIRONMENT}"'


def _obstacle(solid: Mapping[str, Any]) -> str:
    kind = next((kind for kind in ("box", "cylinder", "sphere", "capsule") if solid.get(kind)), None)
    if kind is None:
        return ""  # meshes: see the limits in docs/twin.md
    p = solid[kind]
    lengths = {
        "box": [p[edge] / 2 for edge in "xyz"] if kind == "box" else [],
        "cylinder": [p.get("radius"), p.get("height", 0) / 2],
        "sphere": [p.get("radius")],
        "capsule": [p.get("radius"), (p.get("length") or 1) / 2],
    }[kind]
    size = " ".join(f"{length / 1000!r}" for length in lengths)
    name = quoteattr(f"obstacle {solid['name']}")
    contacts = f'contype="{ENVIRONMENT}" conaffinity="{(1 << GROUPS) - 1}"'
    return f'<geom name={name} type="{kind}" size="{size}" {_pose(solid["pose"])} rgba=".6 .6 .6 .6" {contacts}/>'


def _pose(pose: Mapping[str, float]) -> str:
    at = _metres((pose["x"], pose["y"], pose["z"]))
    return f'pos="{at}" euler="{pose["a"]!r} {pose["b"]!r} {pose["c"]!r}"'


def _metres(at: Sequence[float]) -> str:
    return " ".join(repr(float(one) / 1000) for one in at)
