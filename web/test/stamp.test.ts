import assert from "node:assert/strict";
import { test } from "node:test";
import { fault, stamped } from "../api/stamp.ts";

const inputs = { document: '{"openapi":"3.1.0"}\n', lock: "{}\n" };
const file = stamped(inputs, "export interface paths {}\n");

test("a generated file is known by its document, its generator and its own text", () => {
  assert.equal(fault(inputs, file), null);
  for (const changed of [
    { ...inputs, document: `${inputs.document} ` },
    { ...inputs, lock: "[]\n" },
  ])
    assert.match(fault(changed, file) ?? "", /older/);
  // Two texts are not one: what moves from one file to the other is seen too.
  assert.match(fault({ document: inputs.document.slice(0, -1), lock: `\n${inputs.lock}` }, file) ?? "", /older/);
});

test("an edited or a hand-written file is refused", () => {
  for (const edited of [file.replace("{}", "{ more: 1 }"), `${file}\n`, "export interface paths {}\n", ""]) assert.match(fault(inputs, edited) ?? "", /by hand/);
});
