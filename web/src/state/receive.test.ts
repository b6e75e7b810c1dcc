import { describe, expect, it } from "vitest";

import type { ErrorMessage, ServerMessage } from "../protocol";
import { aRobot } from "../testing/robot";
import { aWalk } from "../testing/walk";
import { received } from "./receive";
import { useStudio, type Studio } from "./store";

const EMPTY = useStudio.getInitialState();

function after(studio: Studio, ...messages: [ServerMessage, Parameters<typeof received>[2]][]): Studio {
  return messages.reduce((now, [message, asked]) => ({ ...now, ...received(now, message, asked) }), studio);
}

const done = (id: number, state: string | null = null): ServerMessage => ({
  type: "done",
  id,
  dropped: false,
  undo: true,
  redo: false,
  state,
});
const error = (id: number): ErrorMessage => ({
  type: "error",
  id,
  kind: "stroke",
  text: "too long",
  problems: [],
  longest_stroke_mm: 90,
});

describe("messages of the server", () => {
  it("keep the text of the state if it is unchanged", () => {
    expect(after(EMPTY, [done(1, "abc"), "view"], [done(2), "walk"]).stateText).toBe("abc");
  });

  it("keep an error until a message of its type succeeds", () => {
    const refused = after(EMPTY, [error(1), "walk"], [done(1), "walk"]);
    expect(refused.failures.walk?.text).toBe("too long");
    expect(after(refused, [done(2), "workspace"]).failures.walk?.text).toBe("too long");
    expect(after(refused, [done(3), "walk"]).failures.walk).toBeUndefined();
  });

  it("do not return to a view that was left meanwhile", () => {
    const here = { view: "body", walk: { swing_height_mm: 1 } } as Studio["state"];
    const sent = {
      type: "state",
      id: 4,
      state: { view: "robot", walk: { swing_height_mm: 2 } },
    } as ServerMessage;
    const studio = { ...EMPTY, state: here };
    expect(received(studio, sent, "document", (type) => type === "view").state).toMatchObject({
      view: "body",
      walk: { swing_height_mm: 2 },
    });
    expect(received(studio, sent, "document").state?.view).toBe("robot");
  });

  it("show the errors of a view beside its inputs", () => {
    const state = { view: "walk" } as Studio["state"];
    const opened = after({ ...EMPTY, state }, [error(1), "view"], [done(1), "view"], [done(2), "view"]);
    expect(opened.failures.walk?.text).toBe("too long");
    expect(after(opened, [aWalk(), "walk"]).failures.walk).toBeUndefined();
  });

  it("show errors of a robot file beside the file", () => {
    const state = { view: "walk" } as Studio["state"];
    const refused = after({ ...EMPTY, state, robot: aRobot() }, [error(5), "toml"], [done(5), "toml"]);
    expect(refused.failures.toml?.text).toBe("too long");
    expect(refused.failures.walk).toBeUndefined();
  });

  it("discard the walk of another robot, unless the new robot came with one", () => {
    const robot = { ...aRobot(), id: 7 };
    const walking: Studio = { ...EMPTY, walk: aWalk() };
    expect(after(walking, [robot, "document"], [done(7), "document"]).walk).toBeNull();
    const anew = { ...aWalk(), id: 7 };
    expect(after(walking, [robot, "document"], [anew, "document"], [done(7), "document"]).walk).toBe(anew);
  });

  it("discard the loads of the previous walk", () => {
    const studio = { ...EMPTY, loads: { id: 1 } as Studio["loads"] };
    expect(after(studio, [aWalk(), "walk"]).loads).toBeNull();
  });
});
