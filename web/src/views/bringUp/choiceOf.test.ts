import { describe, expect, it } from "vitest";

import { choiceOf } from "./choiceOf";

describe("keys of a question", () => {
  const choices = ["", "1", "c", "++"].map((key) => ({ key, text: key }));

  it("are those of the choices, and Enter for the one without a key", () => {
    expect(choiceOf({ choices }, "Enter")).toBe("");
    expect(choiceOf({ choices }, "1")).toBe("1");
    expect(choiceOf({ choices }, "C")).toBe("c");
  });

  it("are no others", () => {
    for (const key of ["2", "Tab", "+", "", "Escape"].filter(Boolean))
      expect(choiceOf({ choices }, key)).toBeNull();
    expect(choiceOf({ choices: choices.slice(1) }, "Enter")).toBeNull();
  });
});
