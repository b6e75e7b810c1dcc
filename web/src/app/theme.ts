import { create } from "zustand";

import { DARK, LIGHT, type Palette } from "../scene/palette";

export type Theme = "light" | "dark";
const KEY = "tarsus-theme";
const dark = window.matchMedia("(prefers-color-scheme: dark)");

function chosen(): Theme | null {
  try {
    const kept = window.localStorage.getItem(KEY);
    return kept === "light" || kept === "dark" ? kept : null;
  } catch {
    // Storage may be forbidden, for example in a file opened from disk.
    return null;
  }
}

/** Light or dark: the user's choice, else the system's. */
export const useTheme = create<{ theme: Theme }>(() => ({
  theme: chosen() ?? (dark.matches ? "dark" : "light"),
}));

/** Apply the system's theme until the user chooses one. */
export function beginTheme(): void {
  const apply = ({ theme }: { theme: Theme }) => document.documentElement.setAttribute("data-theme", theme);
  apply(useTheme.getState());
  useTheme.subscribe(apply);
  dark.addEventListener("change", () => {
    if (!chosen()) useTheme.setState({ theme: dark.matches ? "dark" : "light" });
  });
}

export function toggleTheme(): void {
  const theme: Theme = useTheme.getState().theme === "dark" ? "light" : "dark";
  useTheme.setState({ theme });
  try {
    window.localStorage.setItem(KEY, theme);
  } catch {
    // The choice is then lost when the page is closed.
  }
}

export function usePalette(): Palette {
  return useTheme(({ theme }) => (theme === "dark" ? DARK : LIGHT));
}
