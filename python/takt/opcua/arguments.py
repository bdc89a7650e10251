"""Arguments of methods: their types in OPC UA, and the conversion of a client's values to those of the engine."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import yaml
from asyncua import ua

from takt.arguments import to_text
from takt.opcua.descriptions import Argument, enumerations
from takt.yaml_text import load

Types = Mapping[str, ua.NodeId]  # data types of enumerations, by name

BUILT_IN = {
    "bool": ua.ObjectIds.Boolean,
    "integer": ua.ObjectIds.Int64,
    "real": ua.ObjectIds.Double,
    "text": ua.ObjectIds.String,
    "yaml": ua.ObjectIds.String,
}
INTEGERS = {
    *(ua.VariantType.SByte, ua.VariantType.Byte, ua.VariantType.Int16, ua.VariantType.UInt16),
    *(ua.VariantType.Int32, ua.VariantType.UInt32, ua.VariantType.Int64, ua.VariantType.UInt64),
}
REALS = INTEGERS | {ua.VariantType.Float, ua.VariantType.Double}


class RefusedError(Exception):
    """A call is rejected: its status code, and those of its arguments."""

    def __init__(self, status: int, arguments: Sequence[int] = ()) -> None:
        super().__init__(status)
        self.status = status
        self.arguments = list(arguments)


def described(argument: Argument, types: Types) -> ua.Argument:
    """Returns the OPC UA description of an argument. An optional real number is left out as NaN; an optional boolean,
    integer or enumeration is left out as null, so its data type is BaseDataType."""
    data_type = types[argument.enumeration] if argument.enumeration else ua.NodeId(BUILT_IN[argument.kind])
    open_type = argument.unset and argument.kind in ("bool", "integer", "enum") and not argument.is_list
    about = argument.about
    if open_type:
        data_type = ua.NodeId(ua.ObjectIds.BaseDataType)
        about += f" Null, or {'a member by number or name' if argument.enumeration else argument.kind}."
    if argument.kind == "yaml":
        about += " As YAML in a line: [{x: 1, y: 2}]."
    if argument.enumeration:
        about += f" {_members(argument.enumeration)}"
    return ua.Argument(
        Name=argument.name,
        DataType=data_type,
        ValueRank=ua.ValueRank.OneDimension if argument.is_list else ua.ValueRank.Scalar,
        ArrayDimensions=[0] if argument.is_list else [],
        Description=ua.LocalizedText(about),
    )


def _members(enumeration: str) -> str:
    return ", ".join(f"{number}: {name}" for number, name in enumerate(enumerations()[enumeration].members)) + "."


def values_of(arguments: Sequence[Argument], given: Sequence[ua.Variant]) -> dict[str, Any]:
    """Returns the values for the engine by name, without arguments that were left out. Raises RefusedError if there are
    too many or too few arguments, or one is of another type or no member of its enumeration; the engine checks all
    else."""
    if len(given) > len(arguments):
        raise RefusedError(ua.StatusCodes.BadTooManyArguments)
    if any(not argument.has_default for argument in arguments[len(given) :]):
        raise RefusedError(ua.StatusCodes.BadArgumentsMissing)
    values: dict[str, Any] = {}
    wrong = []
    for argument, variant in zip(arguments, given, strict=False):
        try:
            value = _value(argument, variant)
        except (TypeError, ValueError) as error:
            mismatch = isinstance(error, TypeError)
            wrong.append(ua.StatusCodes.BadTypeMismatch if mismatch else ua.StatusCodes.BadOutOfRange)
            continue
        wrong.append(ua.StatusCodes.Good)
        if value is not None:
            values[argument.name] = value
    if any(wrong):
        raise RefusedError(ua.StatusCodes.BadInvalidArgument, wrong)
    return values


def _value(argument: Argument, variant: ua.Variant) -> Any:
    value = variant.Value
    if value is None:
        return None
    if argument.is_list:
        if not isinstance(value, list):
            raise TypeError
        items = [_scalar(argument, item, variant.VariantType) for item in value]
        return items or None
    if isinstance(value, list):
        raise TypeError
    return _scalar(argument, value, variant.VariantType)


def _scalar(argument: Argument, value: Any, given: ua.VariantType) -> Any:
    if argument.enumeration:
        members = enumerations()[argument.enumeration].members
        if given in INTEGERS:
            if not 0 <= int(value) < len(members):
                raise ValueError
            return members[int(value)]
        if given != ua.VariantType.String:
            raise TypeError
        if value and value not in members:
            raise ValueError
        return value or None
    expected = {"bool": {ua.VariantType.Boolean}, "integer": INTEGERS, "real": REALS}.get(
        argument.kind, {ua.VariantType.String}
    )
    if given not in expected:
        raise TypeError
    if argument.kind == "real":
        return None if math.isnan(value) else float(value)
    if argument.kind == "text" and argument.has_default:
        return value or None
    if argument.kind == "yaml":
        try:
            loaded = load(value) if value else None
        except yaml.YAMLError:
            raise ValueError from None
        to_text({"value": loaded})  # raises ValueError if a key is not a name
        return loaded
    return value
