import type { ErrorMessage, ServerMessage, StudioState } from "../protocol";
import type { ClientType } from "./outbox";
import type { Studio, View } from "./store";

/**
 * Changes of the store by a message of the server.
 *
 * `isNewer`: whether a message of a type was sent after the request that is answered.
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
      // Earlier errors belong to inputs that have been replaced.
      return { state: keepingNewer(message.state, studio.state, isNewer), failures: {}, edited: {} };
    case "pose":
      return { poses: { ...studio.poses, [message.view]: message } };
    case "walk":
      return {
        walk: message,
        loads: null,
        simulated: null,
        failures: { ...studio.failures, walk: undefined, simulate: undefined },
      };
    case "terrain":
      // Servos or terrain have changed.
      return { terrain: message, simulated: null, failures: { ...studio.failures, simulate: undefined } };
    case "simulated":
      return { simulated: message };
    case "loads":
      return { loads: message, failures: { ...studio.failures, loads: undefined } };
    case "servos":
      return { servos: message };
    case "workspace":
      return { workspace: message };
    case "source":
      return { source: message };
    case "bring_up":
      return { bringUp: message, failures: { ...studio.failures, answer: undefined } };
    case "calibration":
      return { calibration: message };
    case "error":
      return refused(studio, message, asked);
    case "done":
      return finished(studio, message, asked);
    case "frame":
    case "file":
      return {};
  }
}

/** The state of the server, with the parts that the user has changed since the request. */
function keepingNewer(
  sent: StudioState,
  here: StudioState | null,
  isNewer: (type: ClientType) => boolean,
): StudioState {
  if (!here) return sent;
  const kept: Partial<StudioState> = isNewer("view") ? { view: here.view, picture: here.picture } : {};
  for (const part of ["joints", "body", "walk", "physics", "loads", "source"] as const) {
    if (isNewer(part)) Object.assign(kept, { [part]: here[part] });
  }
  return { ...sent, ...kept };
}

/** Message type of the inputs of each view. */
const REQUESTS: Partial<Record<View, ClientType>> = {
  joints: "joints",
  body: "body",
  walk: "walk",
  drive: "drive",
  loads: "loads",
  sources: "source",
};

/** Store an error for the inputs that caused it. */
function refused(studio: Studio, error: ErrorMessage, asked: ClientType | null): Partial<Studio> {
  // The robot or the view was changed, but its content is not possible.
  const ofView = asked === "view" || (error.id !== null && studio.robot?.id === error.id);
  const view = studio.state?.view;
  const about = ofView && view ? (REQUESTS[view] ?? asked) : asked;
  return about ? { failures: { ...studio.failures, [about]: error } } : {};
}

type Done = Extract<ServerMessage, { type: "done" }>;

function finished(studio: Studio, done: Done, asked: ClientType | null): Partial<Studio> {
  const changes: Partial<Studio> = { undo: done.undo, redo: done.redo };
  if (done.state !== null) changes.stateText = done.state;
  // Results for another robot are discarded, unless they were sent again with this one.
  if (studio.robot?.id === done.id) {
    const old = (answer: { id: number } | null) => answer !== null && answer.id !== done.id;
    if (old(studio.walk)) changes.walk = null;
    if (old(studio.loads)) changes.loads = null;
    if (old(studio.simulated)) changes.simulated = null;
    if (old(studio.workspace)) changes.workspace = null;
    changes.servos = null;
    changes.poses = Object.fromEntries(Object.entries(studio.poses).filter(([, pose]) => !old(pose)));
  }
  if (asked) {
    changes.busy = { ...studio.busy, [asked]: false };
    const failure = studio.failures[asked];
    // An error with another id belongs to an earlier request, which this one has corrected.
    if (failure && failure.id !== done.id) changes.failures = { ...studio.failures, [asked]: undefined };
  }
  return changes;
}
