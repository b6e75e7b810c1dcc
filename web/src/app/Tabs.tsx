import { useRef, type KeyboardEvent } from "react";

import { Icon } from "../controls/icons";
import { look } from "../state/session";
import { useStudio, type View } from "../state/store";
import { TABS } from "./tabList";

const STEPS: Record<string, number> = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 };

/** Tabs of the views, with the usual arrow keys. */
export function Tabs({ view }: { view: View }) {
  const list = useRef<HTMLDivElement>(null);
  // A server that belongs to a run has the view Drive only.
  const runs = useStudio((studio) => studio.welcome?.run != null);
  const tabs = runs ? TABS.filter((tab) => tab.view === "drive") : TABS;
  const go = (to: View) => {
    openView(to);
    list.current?.querySelector<HTMLButtonElement>(`#tab-${to}`)?.focus();
  };
  const keys = (event: KeyboardEvent) => {
    const at = tabs.findIndex((tab) => tab.view === view);
    const ends: Record<string, number> = { Home: 0, End: tabs.length - 1 };
    const step = STEPS[event.key];
    const next = step === undefined ? ends[event.key] : (at + step + tabs.length) % tabs.length;
    const tab = next === undefined ? undefined : tabs[next];
    if (!tab) return;
    event.preventDefault();
    go(tab.view);
  };
  return (
    <nav className="tabs" aria-label="Views">
      <div role="tablist" aria-label="Views" ref={list}>
        {tabs.map((tab) => (
          <button
            key={tab.view}
            id={`tab-${tab.view}`}
            type="button"
            role="tab"
            className="tab"
            aria-selected={tab.view === view}
            aria-controls="panel"
            tabIndex={tab.view === view ? 0 : -1}
            data-testid={`tab-${tab.view}`}
            onClick={(event) => {
              openView(tab.view);
              // After a click the arrow keys drive; reached by keyboard, the tab keeps the focus, and they change the tab.
              if (tab.view === "drive" && event.detail > 0) event.currentTarget.blur();
            }}
            onKeyDown={keys}
          >
            <Icon name={tab.view} />
            {tab.label}
          </button>
        ))}
      </div>
    </nav>
  );
}

/** Open a view; in Drive the camera follows the robot. */
function openView(view: View) {
  look(view, view === "drive" ? { camera: "follow" } : {});
}
