#!/usr/bin/env python3
"""Writes schema.json: what jsonschema 4 (draft 2020-12) finds wrong with values of random schemas. Needs jsonschema; seed 11.

An error stands at the field that is missing, unknown or badly named, or at the item that is too many; where all but one alternative is null, at the places inside that one.
Errors inside a value that breaks a rule of the same schema itself (its type, its length …) are left out: kelir does not look there.
"""
import json
import random
from pathlib import Path

from jsonschema import Draft202012Validator

rng = random.Random(11)
NAMES = ["rt", "onset", "a/b", "til~de", "choice", "frames", "ünï"]
TEXTS = ["", "a", "ab", "left", "right", "näher", "\U0001f441\U0001f441", "a longer text"]
OF_ITSELF = {"type", "enum", "const", "minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum", "minLength", "maxLength", "minItems",
             "maxItems", "minProperties", "maxProperties"}


def number():
    return rng.choice([0, 1, -1, 2.0, 2.5, 7, 86400000, -0.5, 1e12])


def schema(depth, components):
    kinds = ["number", "integer", "string", "boolean", "enum", "const", "null"]
    if depth > 0:
        kinds += ["object", "object", "object", "array", "array", "map", "option", "oneOf", "anyOf", "allOf", "ref", "any"]
    kind = rng.choice(kinds)
    if kind in ("number", "integer"):
        rules = {"type": kind}
        if rng.random() < 0.6:
            rules[rng.choice(["minimum", "exclusiveMinimum"])] = rng.choice([0, -1, 1.5])
        if rng.random() < 0.6:
            rules[rng.choice(["maximum", "exclusiveMaximum"])] = rng.choice([2, 7, 86400000])
        if rng.random() < 0.3:
            rules["type"] = [kind, "null"]
        return rules
    if kind == "string":
        rules = {"type": "string"}
        if rng.random() < 0.5:
            rules["maxLength"] = rng.choice([1, 2, 5])
        if rng.random() < 0.3:
            rules["minLength"] = 1
        return rules
    if kind == "enum":
        return {"type": "string", "enum": rng.sample(TEXTS, 3)}
    if kind == "const":
        return {"const": rng.choice([1, "left", None, True])}
    if kind in ("boolean", "null"):
        return {"type": kind}
    if kind == "object":
        names = rng.sample(NAMES, rng.randint(1, 3))
        rules = {"type": "object", "properties": {name: schema(depth - 1, components) for name in names}}
        rules["required"] = [name for name in names if rng.random() < 0.5]
        if rng.random() < 0.3:
            rules["additionalProperties"] = False
        return rules
    if kind == "map":
        rules = {"type": "object", "additionalProperties": schema(depth - 1, components)}
        if rng.random() < 0.5:
            rules["propertyNames"] = {"type": "string", "maxLength": 3}
        if rng.random() < 0.5:
            rules["maxProperties"] = 2
        return rules
    if kind == "array":
        rules = {"type": "array", "items": schema(depth - 1, components)}
        if rng.random() < 0.4:
            rules["prefixItems"] = [schema(depth - 1, components) for _ in range(2)]
            rules["items"] = rng.choice([False, rules["items"]])
        if rng.random() < 0.5:
            rules["maxItems"] = 2
        if rng.random() < 0.5:
            rules["minItems"] = 1
        return rules
    if kind == "option":
        return {"oneOf": rng.sample([{"type": "null"}, schema(depth - 1, components)], 2)}
    if kind in ("oneOf", "anyOf"):
        return {kind: [schema(depth - 1, components) for _ in range(rng.randint(2, 3))]}
    if kind == "allOf":
        return {"allOf": [schema(depth - 1, components) for _ in range(2)]}
    if kind == "ref":
        name = f"C{len(components)}"
        components[name] = None
        components[name] = schema(depth - 1, components)
        return {"$ref": f"#/components/schemas/{name}", "description": "A part."}
    return {}


def anything(depth=1):
    choices = [None, True, False, number(), rng.choice(TEXTS)]
    if depth > 0:
        choices += [[anything(0) for _ in range(rng.randint(0, 3))], {rng.choice(NAMES): anything(0) for _ in range(2)}]
    return rng.choice(choices)


def value(rules, components):
    """A value that the schema probably allows; now and then anything."""
    if rng.random() < 0.12:
        return anything()
    if "$ref" in rules:
        return value(components[rules["$ref"].rsplit("/", 1)[1]], components)
    for key in ("oneOf", "anyOf"):
        if key in rules:
            return value(rng.choice(rules[key]), components)
    if "allOf" in rules:
        parts = [value(part, components) for part in rules["allOf"]]
        return {**parts[0], **parts[1]} if all(isinstance(part, dict) for part in parts) else rng.choice(parts)
    if "enum" in rules:
        return rng.choice(rules["enum"])
    if "const" in rules:
        return rules["const"]
    kind = rules.get("type")
    if isinstance(kind, list):
        kind = rng.choice(kind)
    if kind == "number":
        return number()
    if kind == "integer":
        return rng.choice([0, 1, 2, 7, 3.0, -1])
    if kind == "string":
        return rng.choice(TEXTS)
    if kind == "boolean":
        return rng.random() < 0.5
    if kind == "array":
        first = rules.get("prefixItems", [])
        rest = rules["items"] if isinstance(rules["items"], dict) else {}
        return [value(first[i] if i < len(first) else rest, components) for i in range(rng.randint(0, 3))]
    if kind == "object":
        made = {name: value(part, components) for name, part in rules.get("properties", {}).items() if rng.random() < 0.9}
        more = rules.get("additionalProperties")
        if isinstance(more, dict):
            made |= {rng.choice(NAMES): value(more, components) for _ in range(rng.randint(0, 3))}
        elif rng.random() < 0.1:
            made[rng.choice(NAMES)] = anything(0)
        return made
    return None if kind == "null" else anything()


def flat(errors):
    """(path, path of the schema, keyword) of every error."""
    for error in errors:
        path, rule = list(error.absolute_path), list(error.absolute_schema_path)
        if error.validator in ("oneOf", "anyOf"):
            parts = error.validator_value
            other = [i for i, part in enumerate(parts) if part != {"type": "null"}]
            if len(other) == 1 and len(parts) == 2 and error.context:
                yield from flat(e for e in error.context if e.relative_schema_path[0] == other[0])
                continue
        if error.validator == "required":
            for name in error.validator_value:
                if name not in error.instance:
                    yield path + [name], rule, error.validator
        elif error.validator == "additionalProperties":
            for name in set(error.instance) - set(error.schema.get("properties", {})):
                yield path + [name], rule, error.validator
        elif error.validator == "items" and error.validator_value is False:
            for index in range(len(error.schema.get("prefixItems", [])), len(error.instance)):
                yield path + [index], rule, "false"
        elif "propertyNames" in rule:
            yield path + [error.instance], rule, "propertyNames"
        else:
            yield path, rule, error.validator


def begins(longer, start):
    return len(longer) > len(start) and longer[: len(start)] == start


def pointer(path):
    return "".join("/" + str(step).replace("~", "~0").replace("/", "~1") for step in path)


def places(validator, instance):
    found = list(flat(validator.iter_errors(instance)))
    of_itself = [(path, rule[:-1]) for path, rule, keyword in found if keyword in OF_ITSELF]
    kept = [
        path
        for path, rule, _ in found
        if not any(begins(path, above) and rule[: len(inside)] == inside for above, inside in of_itself)
    ]
    return sorted({pointer(path) for path in kept})


cases = []
while len(cases) < 150:
    components = {}
    rules = schema(3, components)
    if len(json.dumps([rules, components])) < 60:
        continue
    validator = Draft202012Validator({**rules, "components": {"schemas": components}})
    values = []
    for _ in range(20):
        instance = value(rules, components)
        values.append([instance, places(validator, instance)])
    cases.append({"schema": rules, "components": components, "values": values})
out = Path(__file__).with_suffix(".json")
out.write_text("[\n" + ",\n".join(json.dumps(case, ensure_ascii=False, sort_keys=True) for case in cases) + "\n]\n")
wrong = sum(bool(found) for case in cases for _, found in case["values"])
print(len(cases), "schemas,", sum(len(case["values"]) for case in cases), "values,", wrong, "wrong")
