import { StrictMode } from "react";
import { createRoot } from "react-dom/client";
import { Object3D } from "three";

import { beginConsole } from "../scene/console";
import { begin } from "../state/session";
import { App } from "./App";
import { beginTheme } from "./theme";

import "./theme.css";
import "./layout.css";
import "./picture.css";
import "./controls.css";
import "./parts.css";
import "uplot/dist/uPlot.min.css";

// z up, as in the robot's frames.
Object3D.DEFAULT_UP.set(0, 0, 1);

beginConsole();
beginTheme();
begin();
const root = document.getElementById("root");
if (root) {
  createRoot(root).render(
    <StrictMode>
      <App />
    </StrictMode>,
  );
}
