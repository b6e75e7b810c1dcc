import { describe, expect, it } from "vitest";

import type { MathNode } from "../../protocol";
import { linesOf } from "./lines";

const leaf = (tag: MathNode["tag"], text: string): MathNode => ({ tag, text, children: [] });
const row = (...children: MathNode[]): MathNode => ({ tag: "mrow", text: null, children });
const sum = (...terms: string[]): MathNode =>
  terms.map((term) => leaf("mi", term)).reduce((left, right) => row(left, leaf("mo", "+"), right));
const text = (node: MathNode): string => (node.text ?? "") + node.children.map(text).join("");

describe("a formula", () => {
  it("is one line where it fits", () => {
    const formula = row(leaf("mi", "x"), leaf("mo", "="), sum("a", "b"));
    expect(linesOf(formula)).toEqual([formula]);
  });

  it("is broken before a sign, and loses nothing", () => {
    const formula = row(leaf("mi", "x"), leaf("mo", "="), sum("aaaa", "bbbb", "cccc", "dddd"));
    const lines = linesOf(formula, 12).map(text);
    expect(lines).toEqual(["x=aaaa+bbbb", "+cccc+dddd"]);
  });

  it("is not broken within a product or brackets", () => {
    const product = row(leaf("mi", "a".repeat(50)), leaf("mo", "·"), leaf("mi", "b".repeat(50)));
    expect(linesOf(product).map(text)).toEqual([text(product)]);
    const brackets = row(leaf("mo", "("), sum("c", "d"), leaf("mo", ")"));
    const difference = row(leaf("mi", "a".repeat(57)), leaf("mo", "−"), brackets);
    expect(linesOf(difference).map(text)).toEqual(["a".repeat(57), "−(c+d)"]);
  });
});
