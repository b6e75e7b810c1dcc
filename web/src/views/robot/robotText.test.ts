import { describe, expect, it } from "vitest";

import { robotText } from "./robotText";

const bytes = (...parts: (string | number)[]) =>
  Uint8Array.from(
    parts.flatMap((part) => (typeof part === "number" ? [part] : [...new TextEncoder().encode(part)])),
  );

describe("a robot file", () => {
  it("is UTF-8, with or without a mark at its start", () => {
    expect(robotText(bytes('name = "Käfer"'))).toEqual({ text: 'name = "Käfer"' });
    expect(robotText(bytes(0xef, 0xbb, 0xbf, "name"))).toEqual({ text: "name" });
    expect(robotText(bytes())).toEqual({ text: "" });
  });

  it("is refused in latin-1, with the first byte that is wrong, as on the command line", () => {
    const problem = (at: number) => ({ problem: `byte ${at} is not UTF-8; a robot file is a text file` });
    expect(robotText(bytes('name = "K', 0xe4, 'fer"'))).toEqual(problem(9));
    expect(robotText(bytes("ä", 0xe4))).toEqual(problem(2));
    expect(robotText(bytes("ab", 0xe4, 0xe4))).toEqual(problem(2));
    expect(robotText(bytes(0xff, 0xfe))).toEqual(problem(0));
    expect(robotText(bytes("x".repeat(1000), 0xf0, 0x9f, "y".repeat(1000)))).toEqual(problem(1000));
  });
});
