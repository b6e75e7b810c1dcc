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

describe("what the page knows", () => {
  it("keeps the state's text when an answer does not change it", () => {
    expect(after(EMPTY, [done(1, "abc"), "view"], [done(2), "walk"]).stateText).toBe("abc");
  });

  it("keeps a refusal until the same is asked with success", () => {
    const refused = after(EMPTY, [error(1), "walk"], [done(1), "walk"]);
    expect(refused.failures.walk?.text).toBe("too long");
    expect(after(refused, [done(2), "zone"]).failures.walk?.text).toBe("too long");
    expect(after(refused, [done(3), "walk"]).failures.walk).toBeUndefined();
  });

  it("does not lead the visitor back to a view that was left since", () => {
    const here = { view: "body", walk: { swing_height_mm: 1 } } as Studio["state"];
    const told = { type: "state", id: 4, state: { view: "robot", walk: { swing_height_mm: 2 } } } as ServerMessage;
    const studio = { ...EMPTY, state: here };
    expect(received(studio, told, "document", (type) => type === "view").state).toMatchObject({
      view: "body",
      walk: { swing_height_mm: 2 },
    });
    expect(received(studio, told, "document").state?.view).toBe("robot");
  });

  it("puts what a view can't show beside that view's inputs", () => {
    const state = { view: "walk" } as Studio["state"];
    const opened = after({ ...EMPTY, state }, [error(1), "view"], [done(1), "view"], [done(2), "view"]);
    expect(opened.failures.walk?.text).toBe("too long");
    expect(after(opened, [aWalk(), "walk"]).failures.walk).toBeUndefined();
  });

  it("keeps the refusal of a robot file beside the file", () => {
    const state = { view: "walk" } as Studio["state"];
    const refused = after({ ...EMPTY, state, robot: aRobot() }, [error(5), "toml"], [done(5), "toml"]);
    expect(refused.failures.toml?.text).toBe("too long");
    expect(refused.failures.walk).toBeUndefined();
  });

  it("forgets another robot's walk, unless it came anew with this one", () => {
    const robot = { ...aRobot(), id: 7 };
    const walking: Studio = { ...EMPTY, walk: aWalk() };
    expect(after(walking, [robot, "document"], [done(7), "document"]).walk).toBeNull();
    const anew = { ...aWalk(), id: 7 };
    expect(after(walking, [robot, "document"], [anew, "document"], [done(7), "document"]).walk).toBe(anew);
  });

  it("forgets a walk's loads when another walk comes", () => {
    const studio = { ...EMPTY, loads: { id: 1 } as Studio["loads"] };
    expect(after(studio, [aWalk(), "walk"]).loads).toBeNull();
  });
});
