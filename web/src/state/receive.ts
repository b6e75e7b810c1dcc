import type { ErrorMessage, ServerMessage, StudioState } from "../protocol";
import type { ClientType } from "./outbox";
import type { Studio, View } from "./store";

/**
 * What a message of the server changes of what the page knows.
 *
 * `isNewer` tells of which types the visitor has sent something after the question that is answered here.
 */
export function received(
  studio: Studio,
  message: ServerMessage,
  asked: ClientType | null,
  isNewer: (type: ClientType) => boolean = () => false,
): Partial<Studio> {
  switch (message.type) {
    case "welcome":
      return { welcome: message };
    case "robot":
      return { robot: message };
    case "state":
      // What was refused before is of inputs that are no longer there.
      return { state: keepingNewer(message.state, studio.state, isNewer), failures: {} };
    case "pose":
      return { poses: { ...studio.poses, [message.view]: message } };
    case "walk":
      return { walk: message, loads: null, failures: { ...studio.failures, walk: undefined } };
    case "loads":
      return { loads: message, failures: { ...studio.failures, loads: undefined } };
    case "servos":
      return { servos: message };
    case "zone":
      return { zone: message };
    case "source":
      return { source: message };
    case "error":
      return refused(studio, message, asked);
    case "done":
      return finished(studio, message, asked);
    case "frame":
    case "file":
      return {};
  }
}

/** The server's state, but for what the visitor has changed since it was asked. */
function keepingNewer(
  told: StudioState,
  here: StudioState | null,
  isNewer: (type: ClientType) => boolean,
): StudioState {
  if (!here) return told;
  const kept: Partial<StudioState> = isNewer("view") ? { view: here.view, picture: here.picture } : {};
  for (const part of ["joints", "body", "walk", "loads", "source"] as const) {
    if (isNewer(part)) Object.assign(kept, { [part]: here[part] });
  }
  return { ...told, ...kept };
}

/** The question that a view's inputs ask. */
const QUESTIONS: Partial<Record<View, ClientType>> = {
  joints: "joints",
  body: "body",
  walk: "walk",
  drive: "drive",
  loads: "loads",
  sources: "source",
};

/** A refusal belongs beside the inputs that it speaks of. */
function refused(studio: Studio, error: ErrorMessage, asked: ClientType | null): Partial<Studio> {
  // The robot or the view came, but what the view shows of it is not possible.
  const ofView = asked === "view" || (error.id !== null && studio.robot?.id === error.id);
  const view = studio.state?.view;
  const about = ofView && view ? (QUESTIONS[view] ?? asked) : asked;
  return about ? { failures: { ...studio.failures, [about]: error } } : {};
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
