import { SOCKET } from "../protocol";

/** Content of the page's URL: the token of the server, and the state of a shared link. */
export interface Address {
  token: string | null;
  state: string | null;
}

/** Parse a URL. The state is in the fragment, which browsers do not send to servers. */
export function readAddress(href: string): Address {
  const url = new URL(href);
  const hash = new URLSearchParams(url.hash.slice(1));
  return { token: url.searchParams.get("token"), state: hash.get("s") };
}

/** The URL that restores a state; without the token unless asked for, as it is a secret. */
export function writeAddress(href: string, state: string | null, keepToken: boolean): string {
  const url = new URL(href);
  if (!keepToken) url.searchParams.delete("token");
  url.hash = state ? `s=${state}` : "";
  return url.href;
}

/** URL of the socket on the page's host. */
export function socketAddress(href: string): string {
  const page = new URL(href);
  const url = new URL(SOCKET, page);
  url.protocol = page.protocol === "https:" ? "wss:" : "ws:";
  const token = page.searchParams.get("token");
  if (token) url.searchParams.set("token", token);
  return url.href;
}
