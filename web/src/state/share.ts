import { writeAddress } from "./address";
import { notify, useStudio } from "./store";

/** Copy the link that restores exactly this. */
export async function copyLink(): Promise<void> {
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
