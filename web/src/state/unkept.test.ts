import { describe, expect, it } from "vitest";

import type { Draft } from "./outbox";
import { Unkept } from "./unkept";

const joints = (angle: number): Draft => ({ type: "joints", joints: { angles_deg: [angle] }, commit: false });

describe("what is not kept yet", () => {
  it("is the newest of each part, and is told once", () => {
    const unkept = new Unkept();
    [joints(1), joints(2), { type: "undo" } as Draft].forEach((draft) => unkept.add(draft));
    expect(unkept.take()).toEqual([{ ...joints(2), commit: true }]);
    expect(unkept.take()).toEqual([]);
  });

  it("is nothing when the state's text holds it, or another state took its place", () => {
    const unkept = new Unkept();
    unkept.add(joints(1));
    unkept.kept("joints");
    expect(unkept.take()).toEqual([]);
    unkept.add(joints(1));
    unkept.forget();
    expect(unkept.take()).toEqual([]);
  });
});
