#!/usr/bin/env python3
"""Writes rig.schema.json from its parts, and protocols/README.md, the reference of all keys, from
the JSON schemas.

--check writes nothing; exit code 1 if a file is not what would be written.
Either way exit code 1 if a key lacks its description, or its default where it may be missing.
"""
import json
import os
import pathlib
import sys
import textwrap

sys.dont_write_bytecode = True
import protocol_schema
import rig_schema

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
README = HERE.parent / "README.md"
SCRIPT = "protocols/schema/write_readme.py"
WIDTH = 100

# Where the examples come from; others than the first are for what no shipped file has.
PAPER = "protocols/paper/discrimination.yaml"
EVERY_KEY = "tests/data/every_key.yaml"
SPIDAR = "protocols/rigs/spidar_g6.yaml"
EXAMPLES = {
    "protocol": {
        "": [PAPER],
        "rendering": ["protocols/paper/reality_finger.yaml"],
        "materials": [PAPER, EVERY_KEY],
        "plates": [PAPER, EVERY_KEY],
        "recordings": [EVERY_KEY],
        "contacts": ["protocols/examples/plate_on_feet.yaml"],
        "stimuli": [PAPER, EVERY_KEY],
        "forms": [EVERY_KEY],
        "display": [EVERY_KEY],
        "block_order": [EVERY_KEY],
        "masking": [EVERY_KEY],
        "simulation": ["protocols/paper/reality_finger.yaml", EVERY_KEY],
    },
    "rig": {"": [SPIDAR], "remote": ["protocols/rigs/remote.yaml"], "replay": [], "vibration_response": [], "audio": [],
            "markers": []},
    "calibration": {"": ["tests/data/spidar_calibration.yaml"]},
}

# By the end of the key's name; the longest counts.
UNITS = {
    "_kg_per_m3": "kg/m³",
    "_n_s_per_m": "N s/m",
    "_n_per_m": "N/m",
    "_n_per_s": "N/s",
    "_per_s": "1/s",
    "_m_s": "m/s",
    "_rad": "rad",
    "_m3": "m³",
    "_db": "dB",
    "_db_fs": "dB FS",
    "_hz": "Hz",
    "_kg": "kg",
    "_pa": "Pa",
    "_m": "m",
    "_n": "N",
    "_s": "s",
    "metres_per_unit": "m/unit",
    "metres_per_count": "m/count",
    "volts_per_newton": "V/N",
    "dac_counts_per_volt": "counts/V",
}


def unit_of(key):
    """Of the key; names in a mapping have the unit of the mapping."""
    ends = [end for end in UNITS if key.removesuffix(".*").endswith(end)]
    return UNITS[max(ends, key=len)] if ends else ""


def joined(path, key):
    return f"{path}.{key}" if path else key


def code(value):
    return f"`{value if isinstance(value, str) and value else json.dumps(value)}`"


def number(value):
    """As short as it can be without being rounded."""
    short = f"{value:.5g}"
    mantissa, _, exponent = (short if float(short) == value else str(value)).partition("e")
    return f"{mantissa}e{int(exponent)}" if exponent else mantissa


def bounds(schema):
    words = []
    if "minimum" in schema and "maximum" in schema:
        words.append(f"{number(schema['minimum'])} to {number(schema['maximum'])}")
    else:
        for word, key in [
            ("above {}", "exclusiveMinimum"),
            ("at least {}", "minimum"),
            ("below {}", "exclusiveMaximum"),
            ("at most {}", "maximum"),
        ]:
            if key in schema:
                words.append(word.format(number(schema[key])))
    if "not" in schema and "const" in schema["not"]:
        words.append(f"not {number(schema['not']['const'])}")
    return ", ".join(words)


def list_range(schema):
    items = schema["items"]
    low, high = schema.get("minItems", 0), schema.get("maxItems")
    kind = "mappings" if "properties" in items else "names"
    words = []
    if isinstance(items.get("type"), list) and "object" in items["type"]:
        kind = "texts, each one or one for each language"
    if items.get("type") == "number":
        kind = "numbers"
        words.append("each " + bounds(items))
    if high:
        kind = (f"{low} " if low == high else f"{low} to {high} ") + kind
    elif low:
        words.append(f"at least {low}")
    if schema.get("uniqueItems"):
        words.append("all different")
    return ", ".join(["list of " + kind, *words])


def range_of(schema):
    kind = schema.get("type")
    if "const" in schema:
        return code(schema["const"])
    if "enum" in schema:
        return ", ".join(map(code, schema["enum"]))
    if kind == "array":
        return list_range(schema)
    if kind == "object":
        if "properties" in schema:
            return "mapping"
        return "mapping of names" + (", at least 1" if schema.get("minProperties") else "")
    if "prefixItems" in schema:
        return "mapping, or list of " + ", ".join(map(code, schema["properties"]))
    if isinstance(kind, list) and "object" in kind:
        return "text, or one for each language"
    if isinstance(kind, list):
        return "a name"
    if kind == "string":
        return "one line of text" if "minLength" in schema else "text"
    if kind == "boolean":
        return "`true`, `false`"
    return ("whole, " if kind == "integer" else "") + bounds(schema)


def words_that_require(key, schema):
    """Values of another key that make this one required."""
    words = []
    for rule in schema.get("allOf", []):
        if key in rule["then"].get("required", []):
            (other,) = rule["if"]["properties"].values()
            words += [other["const"]] if "const" in other else other["enum"]
    return words


def choices(schema):
    return [branch["required"] for branch in schema.get("oneOf", [])]


def is_open(key, schema):
    """May be missing whatever the others are."""
    is_chosen = any(key in choice for choice in choices(schema))
    return (
        key not in schema.get("required", [])
        and not is_chosen
        and not words_that_require(key, schema)
    )


def default_of(key, value, schema):
    if not is_open(key, schema):
        words = words_that_require(key, schema)
        if words:
            return "required with " + ", ".join(map(code, words))
        return "required" if key in schema.get("required", []) else "see below"
    return code(value["default"]) if "default" in value else "unset"


def inner(path, schema):
    """Mappings below this one, each with its path."""
    values = [(joined(path, key), value) for key, value in schema.get("properties", {}).items()]
    if isinstance(schema.get("additionalProperties"), dict):
        values.append((path + ".*", schema["additionalProperties"]))
    for name, value in values:
        if value.get("type") == "array":
            name, value = name + "[]", value["items"]
        if value.get("type") == "object" or "properties" in value:
            yield name, value


def rows_of(path, schema):
    """Each key, its schema, its default, whether it may be missing whatever the others are."""
    for key, value in schema.get("properties", {}).items():
        yield key, value, default_of(key, value, schema), is_open(key, schema)
    value = schema.get("additionalProperties")
    if isinstance(value, dict) and "properties" not in value:
        yield path.rpartition(".")[2] + ".*", value, "", False


def table(path, schema):
    cells = [["key", "unit", "default", "range", "meaning"]]
    for key, value, default, _ in rows_of(path, schema):
        text = [code(key), unit_of(key), default, range_of(value), value.get("description", "")]
        cells.append([cell.replace("|", "\\|") for cell in text])
    if len(cells) == 1:
        return []
    widths = [max(len(row[i]) for row in cells) for i in range(4)]
    lines = ["| " + " | ".join([*map(str.ljust, row, widths), row[-1]]) + " |" for row in cells]
    lines.insert(1, "|" + "|".join("-" * (width + 2) for width in widths) + "|---|")
    if choices(schema):
        forms = [" with ".join(map(code, choice)) for choice in choices(schema)]
        lines += ["", *textwrap.wrap(f"Exactly one of: {'; '.join(forms)}.", WIDTH)]
    return lines + [""]


def section_text(file, section, schema):
    """The lines of a section as they stand in the file; "": of all keys that are no sections."""
    keys = [section]
    if not section:
        keys = [key for key, value in schema["properties"].items() if not is_section(value)]
    taken, is_taking = [], False
    for line in (ROOT / file).read_text().splitlines():
        if line and line[0] not in " #-":
            is_taking = line.split(":")[0] in keys
        if is_taking and not line.startswith("#"):
            taken.append(line)
    while taken and not taken[-1]:
        taken.pop()
    if not taken:
        sys.exit(f"{file}: has no '{section}' to show as an example")
    return "\n".join(line for line in taken if section or line)


def flow(value):
    if not isinstance(value, dict):
        return str(value)
    return "{" + ", ".join(f"{key}: {flow(inner)}" for key, inner in value.items()) + "}"


def as_yaml(section, example):
    return f"{section}: {flow(example)}"


def examples(name, section, schema):
    given = EXAMPLES[name]
    for file in given.get(section, given[""]):
        link = os.path.relpath(ROOT / file, README.parent)
        yield f"[`{file}`]({link}):", section_text(file, section, schema)
    for example in schema["properties"].get(section, {}).get("examples", []):
        yield "For example:", as_yaml(section, example)


def example_lines(name, section, schema):
    lines = []
    for heading, text in examples(name, section, schema):
        lines += [heading, "", "```yaml", *text.splitlines(), "```", ""]
    return lines


def is_section(value):
    inside = value.get("items", {}).get("properties") or value.get("properties")
    return bool(inside) or isinstance(value.get("additionalProperties"), dict)


def sentence(text):
    return text[:1].upper() + text[1:] + "."


def nested(path, schema, section):
    """The tables of a mapping and of those in it."""
    rows = table(path, schema)
    lines = [f"#### `{path}`", ""] if rows and path != section else []
    lines += rows
    for name, value in inner(path, schema):
        lines += nested(name, value, section)
    return lines


def schema_lines(name, schema):
    title = schema["title"].removeprefix("tapstudy ").capitalize()
    lines = [f"## {title}", "", schema["description"], "", *table("", schema)]
    lines += example_lines(name, "", schema)
    for path, value in inner("", schema):
        section = path.removesuffix("[]")
        description = schema["properties"][section]["description"]
        lines += [f"### {title}: `{section}`", "", *textwrap.wrap(sentence(description), WIDTH), ""]
        lines += nested(path, value, section)
        lines += example_lines(name, section, schema)
    return lines


def gaps(path, schema):
    for key, value, _, may_be_missing in rows_of(path, schema):
        description = value.get("description", "")
        name = joined(path, key)
        if not description:
            yield f"{name}: has no description"
        elif may_be_missing and "default" not in value and "unset" not in description:
            yield f"{name}: has neither a default nor a description of what holds where it is unset"
    for name, value in inner(path, schema):
        yield from gaps(name, value)


def first_difference(old, new):
    pairs = zip(old.splitlines() + [""], new.splitlines() + [""])
    return next((i for i, (a, b) in enumerate(pairs, 1) if a != b), 1)


def write_or_check(file, text, is_check):
    if not is_check:
        file.write_text(text)
        return
    old = file.read_text() if file.exists() else ""
    if old != text:
        place = f"{file.relative_to(ROOT)}:{first_difference(old, text)}"
        sys.exit(f"{place}: differs from what it is made of (run {SCRIPT})")


def main():
    is_check = sys.argv[1:] == ["--check"]
    for parts in (rig_schema, protocol_schema):
        write_or_check(parts.FILE, parts.assembled(), is_check)
    schemas = {name: json.loads((HERE / f"{name}.schema.json").read_text()) for name in EXAMPLES}
    missing = [f"{name}.schema.json: {gap}" for name in schemas for gap in gaps("", schemas[name])]
    if missing:
        sys.exit("\n".join(missing))
    lines = [(HERE / "readme_intro.md").read_text()]
    for name, schema in schemas.items():
        lines += schema_lines(name, schema)
    write_or_check(README, "\n".join(lines).rstrip() + "\n", is_check)


if __name__ == "__main__":
    main()
