import { createElement, type ReactNode } from "react";

import type { MathNode } from "../../protocol";

/** A formula in MathML, which screen readers read too. */
export function Maths({ node, block }: { node: MathNode; block?: boolean }) {
  return createElement("math", { display: block ? "block" : "inline" }, element(node, 0));
}

function element(node: MathNode, key: number): ReactNode {
  return createElement(node.tag, { key }, node.text ?? undefined, ...node.children.map(element));
}
