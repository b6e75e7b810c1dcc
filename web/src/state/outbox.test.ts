import { describe, expect, it } from "vitest";

import type { ClientMessage } from "../protocol";
import { Outbox, type Draft } from "./outbox";

function anOutbox() {
  const sent: ClientMessage[] = [];
  const outbox = new Outbox((message) => sent.push(message) > 0);
  return { sent, outbox };
}

const joints = (angle: number, commit = false): Draft => ({
  type: "joints",
  joints: { angles_deg: [angle] },
  commit,
});
const angleOf = (message: ClientMessage | undefined) =>
  message?.type === "joints" ? message.joints.angles_deg?.[0] : undefined;

describe("outbox", () => {
  it("has one message of a type in flight, and then sends the newest of the queued ones", () => {
    const { sent, outbox } = anOutbox();
    outbox.put(joints(1));
    outbox.pump(0);
    [2, 3, 4].forEach((angle) => outbox.put(joints(angle)));
    expect(outbox.pump(100)).toBeNull();
    expect(sent.map(angleOf)).toEqual([1]);
    outbox.settle(sent[0]?.id ?? -1);
    outbox.pump(200);
    expect(sent.map(angleOf)).toEqual([1, 4]);
  });

  it("keeps a commit if a newer message replaces it", () => {
    const { sent, outbox } = anOutbox();
    outbox.put(joints(1));
    outbox.pump(0);
    outbox.put(joints(2, true));
    outbox.put(joints(3, false));
    outbox.settle(sent[0]?.id ?? -1);
    outbox.pump(100);
    expect(sent[1]).toMatchObject({ commit: true, joints: { angles_deg: [3] } });
  });

  it("limits the rate of each type, and returns when to try again", () => {
    const { sent, outbox } = anOutbox();
    outbox.put(joints(1));
    outbox.pump(0);
    outbox.settle(sent[0]?.id ?? -1);
    outbox.put(joints(2));
    expect(outbox.pump(5)).toBe(10);
    expect(sent).toHaveLength(1);
    expect(outbox.pump(15)).toBeNull();
    expect(sent).toHaveLength(2);
  });

  it("sends every undo, in order", () => {
    const { sent, outbox } = anOutbox();
    [1, 2, 3].forEach(() => outbox.put({ type: "undo" }));
    for (let i = 0; i < 3; i++) {
      outbox.pump(i * 100);
      expect(sent).toHaveLength(i + 1);
      outbox.settle(sent[i]?.id ?? -1);
    }
  });

  it("keeps the order of commits and undo", () => {
    const { sent, outbox } = anOutbox();
    outbox.put(joints(1));
    outbox.pump(0);
    outbox.put(joints(2, true));
    outbox.pump(1);
    expect(sent).toHaveLength(1);
    outbox.put({ type: "undo" });
    outbox.pump(2);
    expect(sent.map(({ type }) => type)).toEqual(["joints", "joints", "undo"]);
    expect(sent[1]).toMatchObject({ commit: true });
    outbox.put({ type: "undo" });
    outbox.pump(3);
    expect(outbox.isBusy("undo")).toBe(true);
    outbox.put({ type: "body", body: {} as never, commit: false });
    outbox.pump(4);
    expect(sent.slice(3).map(({ type }) => type)).toEqual(["undo", "body"]);
  });

  it("keeps the order of commits that could not be sent", () => {
    const sent: ClientMessage[] = [];
    let open = false;
    const outbox = new Outbox((message) => open && sent.push(message) > 0);
    outbox.put(joints(1, true));
    outbox.put({ type: "undo" });
    outbox.pump(0);
    expect(outbox.isNewer("joints", 0)).toBe(true);
    open = true;
    outbox.pump(100);
    expect(sent.map(({ type }) => type)).toEqual(["joints", "undo"]);
  });

  it("sends changes of one slider while those of another are queued", () => {
    const { sent, outbox } = anOutbox();
    outbox.put(joints(1));
    outbox.pump(0);
    outbox.put(joints(2));
    outbox.put({ type: "body", body: {} as never, commit: false });
    outbox.put({ type: "workspace", leg: 2 });
    outbox.pump(1);
    expect(sent.map(({ type }) => type)).toEqual(["joints", "body", "workspace"]);
  });

  it("does not order messages of independent types", () => {
    const { sent, outbox } = anOutbox();
    outbox.put(joints(1));
    outbox.put({ type: "workspace", leg: 2 });
    outbox.pump(0);
    expect(sent.map(({ type }) => type)).toEqual(["joints", "workspace"]);
  });

  it("gives every message its own id, also after a lost connection", () => {
    const { sent, outbox } = anOutbox();
    outbox.put(joints(1));
    outbox.pump(0);
    outbox.reset();
    outbox.put(joints(2));
    outbox.pump(0);
    expect(new Set(sent.map(({ id }) => id)).size).toBe(2);
  });

  it("keeps messages that could not be sent", () => {
    const sent: ClientMessage[] = [];
    let open = false;
    const outbox = new Outbox((message) => open && sent.push(message) > 0);
    outbox.put(joints(1));
    outbox.pump(0);
    open = true;
    outbox.pump(100);
    expect(sent.map(angleOf)).toEqual([1]);
  });

  it("knows whether a type was sent after a message", () => {
    const { sent, outbox } = anOutbox();
    outbox.put({ type: "undo" });
    outbox.pump(0);
    const undo = sent[0]?.id ?? -1;
    expect(outbox.isNewer("joints", undo)).toBe(false);
    outbox.put(joints(1));
    expect(outbox.isNewer("joints", undo)).toBe(true);
    outbox.pump(100);
    expect(outbox.isNewer("joints", undo)).toBe(true);
    expect(outbox.isNewer("undo", sent[1]?.id ?? -1)).toBe(false);
  });

  it("knows the type of a request until it is settled", () => {
    const { sent, outbox } = anOutbox();
    outbox.put(joints(1));
    expect(outbox.isBusy("joints")).toBe(true);
    outbox.pump(0);
    const id = sent[0]?.id ?? -1;
    expect(outbox.typeOf(id)).toBe("joints");
    expect(outbox.settle(id)).toBe("joints");
    expect(outbox.typeOf(id)).toBeNull();
    expect(outbox.isBusy("joints")).toBe(false);
  });
});
