// Starts the page: the first screen is there already; tables, figures and the replay follow.

import { drawAll, placeOfRun, showFigures } from "./figure.js";
import { startPairs } from "./pairs.js";
import { embeddedData, embeddedText, library } from "./payload.js";
import { startReplay } from "./replay.js";
import { select, selected, startSelection } from "./select.js";
import { startAnswers, startTables } from "./tables.js";
import { startTheme } from "./theme.js";

function startLicences() {
  const place = document.getElementById("licences");
  place.closest("details").addEventListener("toggle", async () => {
    if (!place.textContent) place.textContent = await embeddedText("licence-texts");
  });
}

// The replay is made when its section comes near the screen, or a run is asked for.
function replayOnDemand(data) {
  const place = document.querySelector(".replay");
  if (!place || !data) return async () => null;
  let made = null;
  const make = () => (made ??= library("three").then((three) => startReplay(data, three)));
  const near = new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    near.disconnect();
    make();
  }, { rootMargin: "600px" });
  near.observe(place);
  return make;
}

async function startPage() {
  startTables();
  startLicences();
  startTheme(document.getElementById("theme"));
  const [data, echarts] = await Promise.all([embeddedData(), library("echarts")]);
  showFigures(data.figures, echarts);
  startAnswers(drawAll);
  startPairs(data.pairs, echarts);
  const replay = replayOnDemand(data.replay);
  const show = async (sample) => {
    (await replay())?.chooseSample(sample);
    document.getElementById("replay").scrollIntoView();
  };
  startSelection(data.pairs, (data.replay?.runs ?? []).map((run) => run.sample), show);
  for (const button of document.querySelectorAll("button.load")) {
    button.addEventListener("click", () => show(Number(button.dataset.sample)));
  }
  document.addEventListener("replaytime", async (event) => (await replay())?.goTo(event.detail));
  if (location.hash) document.getElementById(decodeURIComponent(location.hash.slice(1)))?.scrollIntoView();
  // for tests of the page, and for saving it complete
  globalThis.spindriftPage = { drawAll, placeOfRun, replay, select, selected };
  document.documentElement.dataset.ready = "true";
}

startPage();
