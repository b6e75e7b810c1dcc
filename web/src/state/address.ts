import { SOCKET } from "../protocol";

/** What the page's address says: the token of the server's link, and the state that a shared link restores. */
export interface Address {
  token: string | null;
  state: string | null;
}

/** Read an address. The state stands behind the #, so that no server's log ever sees it. */
export function readAddress(href: string): Address {
  const url = new URL(href);
  const hash = new URLSearchParams(url.hash.slice(1));
  return { token: url.searchParams.get("token"), state: hash.get("s") };
}

/** The address that restores a state. A token is left out of it unless asked for: it is a key, not part of the state. */
export function writeAddress(href: string, state: string | null, keepToken: boolean): string {
  const url = new URL(href);
  if (!keepToken) url.searchParams.delete("token");
  url.hash = state ? `s=${state}` : "";
  return url.href;
}

/** Where the socket is, seen from the page. */
export function socketAddress(href: string): string {
  const page = new URL(href);
  const url = new URL(SOCKET, page);
  url.protocol = page.protocol === "https:" ? "wss:" : "ws:";
  const token = page.searchParams.get("token");
  if (token) url.searchParams.set("token", token);
  return url.href;
}
