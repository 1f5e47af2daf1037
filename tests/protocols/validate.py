"""Exit code 0 if the YAML file fits the JSON schema, 1 if not."""
import json
import sys

import jsonschema
import yaml


class Loader(yaml.SafeLoader):
    """YAML as yaml-cpp reads it: 1e-4 is a number (YAML 1.2), not text (YAML 1.1)."""


Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    __import__("re").compile(r"^[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)$"),
    list("-+0123456789."),
)

with open(sys.argv[1]) as schema_file, open(sys.argv[2]) as yaml_file:
    schema = json.load(schema_file)
    document = yaml.load(yaml_file, Loader)
try:
    jsonschema.validate(document, schema, cls=jsonschema.Draft202012Validator)
except jsonschema.ValidationError as error:
    print(error.message, file=sys.stderr)
    sys.exit(1)
