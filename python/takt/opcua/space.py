"""The address space: an object for each component with all values that it publishes, a type for each kind, a method for
each command. Everything is built from descriptions; this module knows no field and no command by name.

Methods belong to the types and are shared by all objects of a type, as OPC 10000-3 allows: a plant of 200 movers has
each command once."""

from __future__ import annotations

import math
from collections.abc import Awaitable, Callable, Iterator, Mapping
from datetime import datetime, timezone
from typing import Any

import numpy as np
from asyncua import Server, ua

from takt.engine import error_name, error_text
from takt.figures import COUNTS
from takt.opcua.arguments import described
from takt.opcua.descriptions import MACHINE, Field, Verb, enumerations, fields_of, figures, verbs_of
from takt.opcua.units import unit
from takt.tables import KINDS, NUMBERS, unit_of, units_of
from takt.view.machine import Machine, Source
from takt.view.overview import Overview
from takt.view.ring import Floats

NAMESPACE = "urn:takt:motion"
Call = Callable[..., Awaitable[ua.CallMethodResult]]
Caller = Callable[[Verb], Call]  # returns the function that executes a verb

ABOUT = {
    "connected": "The engine is heard. While it is not, all that it publishes has the status BadNoCommunication.",
    "trouble": "What is wrong, in a sentence; empty: nothing.",
    "name": "Of the machine file.",
    "version": "Of the engine.",
    "period": "Length of a cycle.",
    "run_id": "Tells one start of the engine from the next.",
}
# The fields of the last command given through this server, to a component or to the machine.
FEEDBACK: Mapping[str, tuple[ua.VariantType, str]] = {
    "command": (ua.VariantType.UInt32, "Its number, as the method returned it; 0: none was given yet."),
    "client": (ua.VariantType.String, "The OPC UA client: its user's name, or its address."),
    "verb": (ua.VariantType.String, "What was commanded."),
    "arguments": (ua.VariantType.String, "With these arguments, as the engine reads them."),
    "state": (ua.VariantType.Int32, "Busy, active, done, aborted or error; the last three are final."),
    "reached": (ua.VariantType.Boolean, "A command that never ends by itself has what it was given for."),
    "error_id": (ua.VariantType.Int32, "Error number; 0: none."),
    "sentence": (ua.VariantType.String, "What is wrong, for people; empty without an error."),
    "value": (ua.VariantType.Double, "What the command found out; active: s that its motion takes as planned."),
    "ticket": (ua.VariantType.Int64, "The engine's number of the command; 0: refused before it got one."),
}
STATES = "FeedbackState"
ANSWER = ("command", "state", "reached", "error_id", "sentence", "value", "ticket")  # the fields that a method returns
NOTHING = (ua.VariantType.Null, None)


class Space:
    """The address space of one machine. Call `make` once, then `show` periodically."""

    def __init__(self, server: Server, index: int, machine: Machine) -> None:
        self.machine = machine
        self._server = server
        self._index = index
        self._session = server.iserver.isession
        self._types: dict[str, ua.NodeId] = {}  # of enumerations
        self._variables: dict[str, list[tuple[ua.NodeId, ua.VariantType]]] = {}  # of each component, by field
        self._texts: dict[str, list[tuple[int, ua.NodeId]]] = {}  # of error numbers: index of the field, the node
        self._seen: dict[str, Floats] = {}  # values written last
        self._figures: dict[str, tuple[ua.NodeId, ua.VariantType]] = {}
        self._seen_figures: dict[str, Any] = {}

    def node(self, name: str) -> ua.NodeId:
        return ua.NodeId(name, self._index)

    # --- built once ---

    async def make(self, engine: Mapping[str, Any], caller: Caller | None, ask: Call | None) -> None:
        """Builds the address space; values are not known until `show` writes them.

        engine: figures of the engine, as published.
        caller: returns the function that executes a verb; None: clients may not command.
        ask: returns the feedback of a command.
        """
        for name, about, members in [
            *((one.name, one.about, one.members) for one in enumerations().values()),
            (STATES, "What has become of a command.", ("busy", "active", "done", "aborted", "error")),
        ]:
            await self._enumeration(name, about, members)
        used = [kind for kind in KINDS if self.machine.names[kind]]
        for kind in (MACHINE, *used):
            await self._type(kind, caller)
        root = self.node(f"/{MACHINE}")
        await self._object(
            root, self.machine.name, ua.NodeId(ua.ObjectIds.ObjectsFolder), MACHINE, ua.ObjectIds.Organizes
        )
        await self._facts(root)
        await self._engine(root, engine)
        for kind in used:
            folder = self.node(f"/{KINDS[kind].section}")
            await self._folder(folder, KINDS[kind].section, root)
            for source in self.machine.sources:
                if source.kind == kind:
                    await self._component(source, folder)
        if caller is not None and ask is not None:
            await self._method(root, "feedback", "What has become of a command until now.", ask)
            number = ua.Argument("command", ua.NodeId(ua.ObjectIds.UInt32), ua.ValueRank.Scalar, [])
            number.Description = ua.LocalizedText("As the method that gave it returned it.")
            await self._arguments(self.node(f"/{MACHINE}/feedback"), [number])
            await self._share(root, MACHINE)
            await self._last_command(root, "/machine")
            for source in self.machine.sources:
                await self._share(self.node(source.name), source.kind)
                await self._last_command(self.node(source.name), source.name)
        await self.silence(ua.StatusCodes.BadWaitingForInitialData)

    async def _add(self, node: ua.NodeId, name: str, parent: ua.NodeId, attributes: Any, **more: Any) -> None:
        item = ua.AddNodesItem()
        item.RequestedNewNodeId, item.ParentNodeId = node, parent
        item.BrowseName = more.get("browse_name") or ua.QualifiedName(name, self._index)
        item.NodeClass = more["node_class"]
        item.ReferenceTypeId = ua.NodeId(more.get("reference", ua.ObjectIds.HasComponent))
        if "type_definition" in more:
            item.TypeDefinition = more["type_definition"]
        attributes.DisplayName = ua.LocalizedText(name)
        attributes.Description = ua.LocalizedText(more.get("about") or name)
        attributes.WriteMask = attributes.UserWriteMask = 0
        item.NodeAttributes = attributes
        for result in await self._session.add_nodes([item]):
            result.StatusCode.check()

    async def _object(
        self, node: ua.NodeId, name: str, parent: ua.NodeId, kind: str, reference: int = ua.ObjectIds.HasComponent
    ) -> None:
        await self._add(
            node,
            name,
            parent,
            ua.ObjectAttributes(),
            node_class=ua.NodeClass.Object,
            reference=reference,
            type_definition=self.node(f"/types/{kind}") if kind else ua.NodeId(ua.ObjectIds.BaseObjectType),
        )

    async def _folder(self, node: ua.NodeId, name: str, parent: ua.NodeId) -> None:
        await self._add(
            node,
            name,
            parent,
            ua.ObjectAttributes(),
            node_class=ua.NodeClass.Object,
            type_definition=ua.NodeId(ua.ObjectIds.FolderType),
        )

    async def _variable(
        self,
        node: ua.NodeId,
        name: str,
        parent: ua.NodeId,
        value: ua.Variant,
        about: str,
        *,
        data_type: ua.NodeId | None = None,
        units: str = "",
    ) -> None:
        attributes = ua.VariableAttributes()
        attributes.Value = value
        attributes.DataType = data_type or ua.NodeId(value.VariantType.value)
        attributes.ValueRank = ua.ValueRank.Scalar
        attributes.AccessLevel = attributes.UserAccessLevel = ua.AccessLevel.CurrentRead.mask
        definition = ua.ObjectIds.AnalogUnitType if units else ua.ObjectIds.BaseDataVariableType
        await self._add(
            node,
            name,
            parent,
            attributes,
            node_class=ua.NodeClass.Variable,
            type_definition=ua.NodeId(definition),
            about=about,
        )
        if units:
            told = ua.Variant(unit(units), ua.VariantType.ExtensionObject)
            await self._property(node, "EngineeringUnits", told, ua.NodeId(ua.ObjectIds.EUInformation))

    async def _property(
        self, of: ua.NodeId, name: str, value: ua.Variant, data_type: ua.NodeId, *, is_list: bool = False
    ) -> None:
        """Adds a property that OPC UA defines."""
        attributes = ua.VariableAttributes()
        attributes.Value, attributes.DataType = value, data_type
        attributes.ValueRank = ua.ValueRank.OneDimension if is_list else ua.ValueRank.Scalar
        attributes.ArrayDimensions = [0] if is_list else None
        attributes.AccessLevel = attributes.UserAccessLevel = ua.AccessLevel.CurrentRead.mask
        await self._add(
            self.node(f"{of.Identifier}/{name}"),
            name,
            of,
            attributes,
            node_class=ua.NodeClass.Variable,
            reference=ua.ObjectIds.HasProperty,
            type_definition=ua.NodeId(ua.ObjectIds.PropertyType),
            browse_name=ua.QualifiedName(name, 0),
        )

    async def _enumeration(self, name: str, about: str, members: tuple[str, ...]) -> None:
        node = self._types[name] = self.node(f"/types/{name}")
        await self._add(
            node,
            name,
            ua.NodeId(ua.ObjectIds.Enumeration),
            ua.DataTypeAttributes(),
            node_class=ua.NodeClass.DataType,
            reference=ua.ObjectIds.HasSubtype,
            about=about,
        )
        texts = ua.Variant([ua.LocalizedText(member) for member in members], ua.VariantType.LocalizedText)
        await self._property(node, "EnumStrings", texts, ua.NodeId(ua.ObjectIds.LocalizedText), is_list=True)

    async def _type(self, kind: str, caller: Caller | None) -> None:
        node = self.node(f"/types/{kind}")
        name = "".join(part.capitalize() for part in kind.split("_")) + "Type"
        await self._add(
            node,
            name,
            ua.NodeId(ua.ObjectIds.BaseObjectType),
            ua.ObjectTypeAttributes(),
            node_class=ua.NodeClass.ObjectType,
            reference=ua.ObjectIds.HasSubtype,
        )
        if caller is None:
            return
        for verb in verbs_of(kind):
            await self._method(node, verb.name, verb.about, caller(verb))
            inputs = [described(argument, self._types) for argument in verb.arguments]
            await self._arguments(self.node(f"/types/{kind}/{verb.name}"), inputs)

    async def _method(self, of: ua.NodeId, name: str, about: str, call: Call) -> None:
        node = self.node(f"{of.Identifier}/{name}")
        attributes = ua.MethodAttributes()
        attributes.Executable = attributes.UserExecutable = True
        await self._add(node, name, of, attributes, node_class=ua.NodeClass.Method, about=about)
        self._session.add_method_callback(node, call)

    async def _arguments(self, method: ua.NodeId, inputs: list[ua.Argument]) -> None:
        data_type = ua.NodeId(ua.ObjectIds.Argument)
        for name, of in (("InputArguments", inputs), ("OutputArguments", self._answer())):
            if of:
                value = ua.Variant(of, ua.VariantType.ExtensionObject)
                await self._property(method, name, value, data_type, is_list=True)

    def _answer(self) -> list[ua.Argument]:
        return [
            ua.Argument(
                Name=name,
                DataType=self._types[STATES] if name == "state" else ua.NodeId(FEEDBACK[name][0].value),
                ValueRank=ua.ValueRank.Scalar,
                ArrayDimensions=[],
                Description=ua.LocalizedText(FEEDBACK[name][1]),
            )
            for name in ANSWER
        ]

    async def _share(self, of: ua.NodeId, kind: str) -> None:
        """Lets an object reference the methods of its type."""
        items = []
        for verb in verbs_of(kind):
            item = ua.AddReferencesItem()
            item.SourceNodeId, item.TargetNodeId = of, self.node(f"/types/{kind}/{verb.name}")
            item.ReferenceTypeId = ua.NodeId(ua.ObjectIds.HasComponent)
            item.IsForward, item.TargetNodeClass = True, ua.NodeClass.Method
            items.append(item)
        for status in await self._session.add_references(items):
            status.check()

    async def _facts(self, root: ua.NodeId) -> None:
        machine = self.machine
        for name, value, units in (
            ("connected", ua.Variant(False, ua.VariantType.Boolean), ""),
            ("trouble", ua.Variant("", ua.VariantType.String), ""),
            ("name", ua.Variant(machine.name, ua.VariantType.String), ""),
            ("version", ua.Variant(machine.version, ua.VariantType.String), ""),
            ("period", ua.Variant(machine.period_s, ua.VariantType.Double), "s"),
            ("run_id", ua.Variant(machine.run_id, ua.VariantType.Int64), ""),
        ):
            await self._variable(self.node(f"/machine/{name}"), name, root, value, ABOUT[name], units=units)

    async def _engine(self, root: ua.NodeId, engine: Mapping[str, Any]) -> None:
        folder = self.node("/engine")
        await self._object(folder, "engine", root, "")
        for name, value in engine.items():
            kind = _plain_type(value)
            if kind is None:
                continue  # a histogram
            node = self.node(f"/engine/{name}")
            about = figures().get(name) or COUNTS.get(name, ("", ""))[1]
            await self._variable(node, name, folder, ua.Variant(*reversed(NOTHING)), about, data_type=_of(kind))
            self._figures[name] = (node, kind)

    async def _component(self, source: Source, folder: ua.NodeId) -> None:
        own = units_of(self.machine.parameters, KINDS[source.kind], source.parameters)
        component = self.node(source.name)
        await self._object(component, source.name, folder, source.kind)
        variables, texts = self._variables[source.name], self._texts[source.name] = [], []
        for place, field in enumerate(fields_of(source.kind)):
            node = self.node(f"{source.name}.{field.name}")
            kind = _type_of(source.kind, field)
            units = unit_of(source.kind, field.name, own) if field.unit else ""
            data_type = self._types[field.enumeration] if field.enumeration else _of(kind)
            empty = ua.Variant(*reversed(NOTHING))
            await self._variable(node, field.name, component, empty, field.about, data_type=data_type, units=units)
            variables.append((node, kind))
            if field.name in NUMBERS:
                text = self.node(f"{source.name}.{field.name}_text")
                about = f"What {field.name} says, for people; empty: nothing."
                string = ua.NodeId(ua.ObjectIds.String)
                await self._variable(text, f"{field.name}_text", component, empty, about, data_type=string)
                texts.append((place, text))

    async def _last_command(self, of: ua.NodeId, name: str) -> None:
        node = self.node(f"{name}/last_command")
        await self._object(node, "last_command", of, "")
        for field, (kind, about) in FEEDBACK.items():
            value = ua.Variant({ua.VariantType.String: "", ua.VariantType.Boolean: False}.get(kind, 0), kind)
            data_type = self._types[STATES] if field == "state" else None
            await self._variable(
                self.node(f"{name}/last_command/{field}"), field, node, value, about, data_type=data_type
            )

    # --- periodic ---

    async def show(self, overview: Overview, engine: Mapping[str, Any] | None) -> None:
        """Writes the values that have changed."""
        now = datetime.now(timezone.utc)
        for source in self.machine.sources:
            values = overview.values(source.index, KINDS[source.kind].units)
            seen = self._seen.get(source.name)
            if seen is None:
                if not overview.heard(source.index):
                    continue
                changed = np.arange(len(values))
            else:
                changed = np.flatnonzero((values != seen) & ~(np.isnan(values) & np.isnan(seen)))
            self._seen[source.name] = values
            variables = self._variables[source.name]
            for place in changed.tolist():
                node, kind = variables[place]
                await self._write(node, _plain(values[place], kind), kind, now)
            for place, node in self._texts[source.name]:
                if seen is None or values[place] != seen[place]:
                    await self._write(node, _sentence(int(values[place])), ua.VariantType.String, now)
        for name, value in (engine or {}).items():
            if name in self._figures and self._seen_figures.get(name) != value:
                self._seen_figures[name] = value
                await self._write(self._figures[name][0], value, self._figures[name][1], now)

    async def tell(self, connected: bool, trouble: str) -> None:
        """Writes the state of the connection to the engine."""
        now = datetime.now(timezone.utc)
        for name, value, kind in (
            ("connected", connected, ua.VariantType.Boolean),
            ("trouble", trouble, ua.VariantType.String),
            ("run_id", self.machine.run_id, ua.VariantType.Int64),
        ):
            await self._write(self.node(f"/machine/{name}"), value, kind, now)

    async def silence(self, status: int = ua.StatusCodes.BadNoCommunication) -> None:
        """Sets all published values to this bad status: they are not known any more."""
        self._seen.clear()
        self._seen_figures.clear()
        now = datetime.now(timezone.utc)
        for node in self._published():
            value = ua.DataValue(StatusCode=ua.StatusCode(status), SourceTimestamp=now, ServerTimestamp=now)
            await self._server.iserver.write_attribute_value(node, value)

    async def tell_of(self, target: str, feedback: Mapping[str, Any]) -> None:
        """Writes the feedback of the last command to a component or the machine."""
        name = "/machine" if target == MACHINE else target
        now = datetime.now(timezone.utc)
        for field, value in feedback.items():
            await self._write(self.node(f"{name}/last_command/{field}"), value, FEEDBACK[field][0], now)

    def _published(self) -> Iterator[ua.NodeId]:
        for name, variables in self._variables.items():
            yield from (node for node, _ in variables)
            yield from (node for _, node in self._texts[name])
        yield from (node for node, _ in self._figures.values())

    async def _write(self, node: ua.NodeId, value: Any, kind: ua.VariantType, now: datetime) -> None:
        told = ua.DataValue(ua.Variant(value, kind), SourceTimestamp=now, ServerTimestamp=now)
        await self._server.iserver.write_attribute_value(node, told)


def answer(feedback: Mapping[str, Any]) -> list[ua.Variant]:
    """Returns the output arguments of a method for this feedback."""
    return [ua.Variant(feedback[name], FEEDBACK[name][0]) for name in ANSWER]


def _of(kind: ua.VariantType) -> ua.NodeId:
    return ua.NodeId(kind.value)


def _type_of(component: str, field: Field) -> ua.VariantType:
    if field.enumeration:
        return ua.VariantType.Int32
    dtype = np.dtype(KINDS[component].dtypes[field.name])
    if dtype == np.bool_:
        return ua.VariantType.Boolean
    return ua.VariantType.Int64 if np.issubdtype(dtype, np.integer) else ua.VariantType.Double


def _plain_type(value: Any) -> ua.VariantType | None:
    if isinstance(value, bool):
        return ua.VariantType.Boolean
    if isinstance(value, int):
        return ua.VariantType.Int64
    return ua.VariantType.Double if isinstance(value, float) else None


def _plain(value: float, kind: ua.VariantType) -> Any:
    if kind == ua.VariantType.Boolean:
        return bool(value)
    return float(value) if kind == ua.VariantType.Double or math.isnan(value) else int(value)


def _sentence(error: int) -> str:
    return f"{error_name(error)}: {error_text(error)}" if error else ""
