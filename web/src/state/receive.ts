import type { ServerMessage } from "../protocol";
import type { ClientType } from "./outbox";
import type { Studio } from "./store";

/** What a message of the server changes of what the page knows. */
export function received(studio: Studio, message: ServerMessage, asked: ClientType | null): Partial<Studio> {
  switch (message.type) {
    case "welcome":
      return { welcome: message };
    case "robot":
      return { robot: message };
    case "state":
      return { state: message.state };
    case "pose":
      return { poses: { ...studio.poses, [message.view]: message } };
    case "walk":
      return { walk: message, loads: null };
    case "loads":
      return { loads: message };
    case "servos":
      return { servos: message };
    case "zone":
      return { zone: message };
    case "source":
      return { source: message };
    case "error":
      return asked ? { failures: { ...studio.failures, [asked]: message } } : {};
    case "done":
      return finished(studio, message, asked);
    case "frame":
    case "file":
      return {};
  }
}

type Done = Extract<ServerMessage, { type: "done" }>;

function finished(studio: Studio, done: Done, asked: ClientType | null): Partial<Studio> {
  const changes: Partial<Studio> = { undo: done.undo, redo: done.redo };
  if (done.state !== null) changes.stateText = done.state;
  // What was worked out for another robot, and did not come anew with this one, would be wrong for it.
  if (studio.robot?.id === done.id) {
    const old = (answer: { id: number } | null) => answer !== null && answer.id !== done.id;
    if (old(studio.walk)) changes.walk = null;
    if (old(studio.loads)) changes.loads = null;
    if (old(studio.zone)) changes.zone = null;
    changes.servos = null;
    changes.poses = Object.fromEntries(Object.entries(studio.poses).filter(([, pose]) => !old(pose)));
  }
  if (asked) {
    changes.busy = { ...studio.busy, [asked]: false };
    const failure = studio.failures[asked];
    // A failure is of this question if it bears its id; else it is of an earlier one, which has now been put right.
    if (failure && failure.id !== done.id) changes.failures = { ...studio.failures, [asked]: undefined };
  }
  return changes;
}
