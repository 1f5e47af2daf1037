"""The JSON schema of a protocol: written by hand, with the schema of each procedure put in."""
import json
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
FILE = HERE / "protocol.schema.json"


def procedures():
    files = sorted((HERE / "procedures").glob("*.json"))
    return {
        "type": "array",
        "items": {
            "type": "object",
            "properties": {file.stem: json.loads(file.read_text()) for file in files},
            "additionalProperties": False,
            "oneOf": [{"required": [file.stem]} for file in files],
        },
        "minItems": 1,
        "description": "what chooses the comparison's level from trial to trial; several are "
        "interleaved; unset: fixed stimuli",
    }


def assembled():
    schema = json.loads(FILE.read_text())
    schema["properties"]["blocks"]["items"]["properties"]["procedures"] = procedures()
    return json.dumps(schema, indent=2, ensure_ascii=False) + "\n"
