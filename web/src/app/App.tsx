import { useEffect } from "react";

import { useStudio } from "../state/store";
import { ViewPanel } from "../views/ViewPanel";
import { Banner } from "./Banner";
import { Header } from "./Header";
import { PicturePane } from "./PicturePane";
import { Tabs } from "./Tabs";
import { Toast } from "./Toast";
import { useShortcuts } from "./useShortcuts";

/** The page. */
export function App() {
  const view = useStudio((studio) => studio.state?.view ?? "walk");
  const name = useStudio((studio) => studio.robot?.name);
  useShortcuts();
  useEffect(() => {
    document.title = name ? `${name} – Tarsus Studio` : "Tarsus Studio";
  }, [name]);
  return (
    <div className="app" data-view={view}>
      <Header />
      <Tabs view={view} />
      <section className="picture" aria-label="Picture">
        <PicturePane view={view} />
        <Banner />
      </section>
      <main className="panel" key={view}>
        <div role="tabpanel" id="panel" aria-labelledby={`tab-${view}`}>
          <ViewPanel view={view} />
        </div>
      </main>
      <Toast />
    </div>
  );
}
