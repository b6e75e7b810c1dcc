import { describe, expect, it } from "vitest";

import type { Draft } from "./outbox";
import { Unkept } from "./unkept";

const joints = (angle: number): Draft => ({ type: "joints", joints: { angles_deg: [angle] }, commit: false });

describe("unsaved changes", () => {
  it("are the newest of each part, and are taken once", () => {
    const unkept = new Unkept();
    [joints(1), joints(2), { type: "undo" } as Draft].forEach((draft) => unkept.add(draft));
    expect(unkept.take()).toEqual([{ ...joints(2), commit: true }]);
    expect(unkept.take()).toEqual([]);
  });

  it("are removed when the state contains them, or is replaced", () => {
    const unkept = new Unkept();
    unkept.add(joints(1));
    unkept.kept("joints");
    expect(unkept.take()).toEqual([]);
    unkept.add(joints(1));
    unkept.forget();
    expect(unkept.take()).toEqual([]);
  });
});
