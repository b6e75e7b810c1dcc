import { describe, expect, it } from "vitest";

import type { Draft } from "./outbox";
import { Unsaved } from "./unsaved";

const joints = (angle: number): Draft => ({ type: "joints", joints: { angles_deg: [angle] }, commit: false });

describe("unsaved changes", () => {
  it("are the newest of each part, and are taken once", () => {
    const unsaved = new Unsaved();
    [joints(1), joints(2), { type: "undo" } as Draft].forEach((draft) => unsaved.add(draft));
    expect(unsaved.take()).toEqual([{ ...joints(2), commit: true }]);
    expect(unsaved.take()).toEqual([]);
  });

  it("are removed when the state contains them, or is replaced", () => {
    const unsaved = new Unsaved();
    unsaved.add(joints(1));
    unsaved.kept("joints");
    expect(unsaved.take()).toEqual([]);
    unsaved.add(joints(1));
    unsaved.forget();
    expect(unsaved.take()).toEqual([]);
  });
});
