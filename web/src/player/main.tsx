import { StrictMode } from "react";
import { createRoot } from "react-dom/client";
import { Object3D } from "three";

import { beginTheme } from "../app/theme";
import type { PlayerData } from "../protocol";
import { beginConsole } from "../scene/console";
import { Player } from "./Player";

import "../app/theme.css";
import "../app/picture.css";
import "../app/controls.css";
import "./player.css";

Object3D.DEFAULT_UP.set(0, 0, 1);

/** The walk that Python has embedded in the page. */
function heldData(): PlayerData | null {
  try {
    return JSON.parse(document.getElementById("motion")?.textContent ?? "") as PlayerData;
  } catch {
    return null;
  }
}

beginConsole();
beginTheme();
const root = document.getElementById("root");
const data = heldData();
if (root && data) {
  document.title = `${data.robot.name}: ${data.walk.gait}`;
  createRoot(root).render(
    <StrictMode>
      <Player data={data} />
    </StrictMode>,
  );
} else if (root) {
  root.textContent = "This page contains no walk.";
}
