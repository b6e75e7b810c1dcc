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
    // Storage may be forbidden, as in a file that is opened from a disk.
    return null;
  }
}

/** Light or dark: as the visitor chose, else as the system is. */
export const useTheme = create<{ theme: Theme }>(() => ({
  theme: chosen() ?? (dark.matches ? "dark" : "light"),
}));

/** Follow the system until the visitor chooses. */
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
    // Then the choice lasts as long as the page.
  }
}

export function usePalette(): Palette {
  return useTheme(({ theme }) => (theme === "dark" ? DARK : LIGHT));
}
