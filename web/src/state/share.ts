import { writeAddress } from "./address";
import { usePlayback } from "./playback";
import { look } from "./session";
import { notify, useStudio } from "./store";

/** Copy the link that restores exactly this. */
export async function copyLink(): Promise<void> {
  await keepMoment();
  const { stateText, welcome } = useStudio.getState();
  // Whoever gets the link of a public server needs no token; of another, the link alone must not open it.
  const href = writeAddress(window.location.href, stateText, false);
  window.history.replaceState(null, "", writeAddress(window.location.href, stateText, true));
  const token = welcome && !welcome.public && window.location.search.includes("token=");
  await copyText(
    href,
    token ? "Link copied, without this server's token" : "Link copied: it restores exactly this",
  );
}

/** Copy a text, and say so; where the clipboard is closed to pages, show it for copying by hand. */
export async function copyText(text: string, said: string): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
    notify(said);
  } catch {
    window.prompt("Copy:", text);
  }
}

/** How long to wait for the server to take in what is looked at [ms]. */
const PATIENCE = 1000;

/** Put the moment of the walk that is shown into the state, and wait for the state's new text. */
async function keepMoment(): Promise<void> {
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
