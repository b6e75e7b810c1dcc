import type { FileMessage, ServerMessage, StudioState } from "../protocol";
import { readAddress, writeAddress } from "./address";
import { showDriveFrame } from "./driving";
import { changedKey } from "./edited";
import { saveBlob } from "./files";
import { Link } from "./link";
import { useOptions } from "./options";
import type { ClientType, Draft } from "./outbox";
import { received } from "./receive";
import { notify, useStudio } from "./store";
import { endsFileRefusal, Unsaved, withPart, type Settable } from "./unsaved";

/** Delay after which the URL is updated [ms]: browsers allow about 100 changes in 30 s. */
const ADDRESS_DELAY = 600;

const unsaved = new Unsaved();
/** The calibration that was loaded in this page; the state has none, so a new session is told of it. */
let calibration: Draft | null = null;
/** Whether the open session has sent its state. */
let greeted = false;
/** Types whose failure to be sent is reported to the user. */
const REPORTED: ReadonlySet<ClientType> = new Set([
  "undo",
  "redo",
  "robot",
  "document",
  "toml",
  "download",
  "servos",
  "bring_up",
  "answer",
]);

const link = new Link({
  status: (status) => {
    if (status.kind !== "open") greeted = false;
    // A bring-up ends with its session; what was answered is saved.
    useStudio.setState(status.kind === "open" ? { link: status } : { link: status, busy: {}, bringUp: null });
  },
  message: receive,
  state: () => useStudio.getState().stateText ?? readAddress(window.location.href).state,
});

/** Connect, and handle changes of the fragment of the URL. */
export function begin(): void {
  link.open();
  for (const sign of ["pointerdown", "keydown"]) {
    window.addEventListener(sign, () => useStudio.getState().link.kind === "asleep" && link.retry());
  }
  window.addEventListener("hashchange", () => {
    const { state } = readAddress(window.location.href);
    if (state && state !== useStudio.getState().stateText) ask({ type: "open", state });
  });
}

/** Reconnect immediately. */
export function retry(): void {
  link.retry();
}

/** Send a message; its answers change the store. */
export function ask(draft: Draft): void {
  if (endsFileRefusal(draft)) forgetFileRefusal();
  unsaved.add(draft);
  if (draft.type === "calibration") calibration = draft;
  if (!link.send(draft)) {
    if (REPORTED.has(draft.type)) notify("Not connected to the server");
    return;
  }
  if (useStudio.getState().busy[draft.type] !== true && link.isBusy(draft.type)) {
    useStudio.setState((studio) => ({ busy: { ...studio.busy, [draft.type]: true } }));
  }
}

function sendUnsaved(): void {
  if (calibration) ask(calibration);
  for (const draft of unsaved.take()) {
    useStudio.setState(({ state }) => ({ state: state && withPart(state, draft) }));
    ask(draft);
  }
}

/**
 * Change a part of the state: shown immediately, and sent. `commit` is false during a movement of slider or mouse.
 */
export function change<K extends Settable>(part: K, values: Partial<StudioState[K]>, commit = true): void {
  const { state } = useStudio.getState();
  if (!state) return;
  const next = { ...state[part], ...values };
  useStudio.setState((studio) => ({
    state: { ...state, [part]: next },
    edited: { ...studio.edited, [part]: changedKey(state[part], next) ?? studio.edited[part] },
  }));
  ask({ type: part, [part]: next, commit, ...wantedForces(part) } as unknown as Draft);
}

/** During a change of a pose, forces are computed only where they are shown. */
function wantedForces(part: Settable | "drag_foot"): { forces?: boolean } {
  return part === "joints" || part === "body" || part === "drag_foot"
    ? { forces: useOptions.getState().forces }
    : {};
}

/** Drag a foot to a position in the ground frame [mm]. */
export function dragFoot(leg: number, position_mm: [number, number, number], commit: boolean): void {
  ask({ type: "drag_foot", leg, position_mm, commit, ...wantedForces("drag_foot") });
}

function forgetFileRefusal(): void {
  useStudio.setState(({ failures }) => ({ failures: { ...failures, toml: undefined } }));
}

/** Change the view, or the camera and time of the 3D view. */
export function look(view: StudioState["view"] | null, picture: Partial<StudioState["picture"]> = {}): void {
  const { state } = useStudio.getState();
  if (!state) return;
  if (view !== null && view !== state.view) forgetFileRefusal();
  const next = { ...state, view: view ?? state.view, picture: { ...state.picture, ...picture } };
  useStudio.setState({ state: next });
  ask({ type: "view", view: next.view, picture: next.picture });
}

function receive(message: ServerMessage, asked: ClientType | null): void {
  if (message.type === "frame") {
    showDriveFrame(message);
    return;
  }
  if (message.type === "file") save(message);
  if (message.type === "error" && asked === null) notify(message.text);
  const { id } = message;
  useStudio.setState((studio) =>
    received(studio, message, asked, (type) => id !== null && link.isNewer(type, id)),
  );
  // A session that has just been opened does not have the latest settings.
  if (message.type === "state" && greeted) unsaved.forget();
  if (message.type !== "done") return;
  if (!greeted) sendUnsaved();
  greeted = true;
  if (message.state === null) return;
  if (asked && id !== null && !link.isNewer(asked, id)) unsaved.kept(asked);
  writeSoon();
}

let writing: number | undefined;

function writeSoon(): void {
  window.clearTimeout(writing);
  writing = window.setTimeout(() => {
    const href = writeAddress(window.location.href, useStudio.getState().stateText, true);
    window.history.replaceState(null, "", href);
  }, ADDRESS_DELAY);
}

function save(file: FileMessage): void {
  saveBlob(file.name, new Blob([file.text], { type: file.mime }));
  notify(`${file.name} saved`);
}
