"""validate.py SCHEMA FILE...: says of each YAML file whether it fits the JSON schema; exit code 0 if all
do, 1 if not."""
import json
import sys

import jsonschema
import yaml


class Loader(yaml.CSafeLoader):
    """YAML as yaml-cpp reads it: 1e-4 is a number (YAML 1.2), not text (YAML 1.1)."""


Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    __import__("re").compile(r"^[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)$"),
    list("-+0123456789."),
)

with open(sys.argv[1]) as schema_file:
    validator = jsonschema.Draft202012Validator(json.load(schema_file))
validator.check_schema(validator.schema)
all_fit = True
for name in sys.argv[2:]:
    with open(name) as yaml_file:
        try:
            content = yaml.load(yaml_file, Loader)
            errors = [error.message for error in validator.iter_errors(content)]
        except yaml.YAMLError as error:
            errors = [str(error)]
    print("fits" if not errors else "differs")
    print(*errors, sep="\n", file=sys.stderr)
    all_fit = all_fit and not errors
sys.exit(not all_fit)
