import { writeAddress } from "./address";
import { usePlayback } from "./playback";
import { look } from "./session";
import { notify, useStudio } from "./store";

/** Copy a link to the present state. */
export async function copyLink(): Promise<void> {
  await storeTime();
  const { stateText, welcome } = useStudio.getState();
  // The token is not part of the link: it must not be passed on by accident.
  const href = writeAddress(window.location.href, stateText, false);
  window.history.replaceState(null, "", writeAddress(window.location.href, stateText, true));
  const token = welcome && !welcome.public && window.location.search.includes("token=");
  await copyText(href, token ? "Link copied, without the token of this server" : "Link to this state copied");
}

/** Copy a text and notify; without access to the clipboard, show it in a dialog. */
export async function copyText(text: string, said: string): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
    notify(said);
  } catch {
    window.prompt("Copy:", text);
  }
}

/** Maximum time to wait for the answer of the server [ms]. */
const PATIENCE = 1000;

/** Put the time of the playback into the state, and wait for its new text. */
async function storeTime(): Promise<void> {
  look(null, { time_s: Math.round(usePlayback.getState().time * 1000) / 1000 });
  if (!isBusy()) return;
  await new Promise<void>((resolve) => {
    const finish = () => {
      window.clearTimeout(timer);
      stop();
      resolve();
    };
    const timer = window.setTimeout(finish, PATIENCE);
    const stop = useStudio.subscribe(() => !isBusy() && finish());
  });
}

function isBusy(): boolean {
  return useStudio.getState().busy.view === true;
}
