"""check_schema.py SCHEMA FILE: exit 1 and what is wrong where FILE is not good by the JSON Schema."""
import json
import sys

import jsonschema

with open(sys.argv[1]) as file:
    schema = json.load(file)
jsonschema.Draft202012Validator.check_schema(schema)
with open(sys.argv[2]) as file:
    errors = list(jsonschema.Draft202012Validator(schema).iter_errors(json.load(file)))
for error in errors:
    print("/".join(map(str, ["", *error.absolute_path])), error.message[:200])
sys.exit(1 if errors else 0)
