"""The JSON schema of a rig: what all devices have in common, and the section of each device."""
import json
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
FILE = HERE / "rig.schema.json"
NEEDED_BY_HARDWARE = ["max_hand_speed_m_s", "workspace_radius_m"]
ONLY_OF_HARDWARE = [*NEEDED_BY_HARDWARE, "force_rise_s", "force_fall_s"]
# Lateness without a limit is for hands that cannot be hurt.
LIMITED_LATENESS = {
    "properties": {"max_late_ticks_in_a_row": {"minimum": 1}, "max_stall_s": {"exclusiveMinimum": 0}}
}


def read(file):
    return json.loads(file.read_text())


def rule_of(device, sections):
    """A device requires its own section, and allows no other's."""
    own = list(device.get("section", {}))
    then = {}
    forbidden = [section for section in sections if section not in own]
    required = list(own)
    if device["has_hardware"]:
        required += NEEDED_BY_HARDWARE
    else:
        forbidden += ONLY_OF_HARDWARE
    if forbidden:
        then["properties"] = {key: False for key in forbidden}
    if device["has_hardware"]:
        then.setdefault("properties", {})["loop"] = LIMITED_LATENESS
    if required:
        then["required"] = required
    condition = {"properties": {"device": {"const": device["device"]}}, "required": ["device"]}
    return {"if": condition, "then": then}


def assembled():
    schema = read(HERE / "rig_common.json")
    devices = [read(file) for file in sorted((HERE / "devices").glob("*.json"))]
    sections = {}
    for device in devices:
        sections.update(device.get("section", {}))
    kind = schema["properties"]["device"]
    schema["properties"]["device"] = {"enum": [device["device"] for device in devices], **kind}
    schema["properties"].update(sections)
    schema["allOf"] = [rule_of(device, sections) for device in devices]
    return json.dumps(schema, indent=2, ensure_ascii=False) + "\n"
