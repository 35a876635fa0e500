// Colours: the palette of Okabe and Ito (2008), light and dark, and the switch between them.

const HUES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#b8a800"];
const HUES_ON_DARK = ["#4aa8e0", "#f07f2e", "#2fc79a", "#e39cc4", "#7cc8f5", "#f2b233", "#f0e442"];
// For wheels beyond the fourth, the angular velocity, and what is about an orbit, behind the colours of text.
const MORE = ["#882255", "#117733", "#999933", "#6a3d9a", "#c0001a", "#7a4a21", "#00808c", "#f59a00", "#b5179e"];
const MORE_ON_DARK = ["#d46a9f", "#5fc27e", "#c9c95a", "#b48be0", "#ff6070", "#c9986a", "#3fd0dc", "#ffc247", "#ff6ad5"];
// Places in the palette of the bodies, which keep their colours everywhere.
export const HUE_PLACES = { body: 0, wheels: [1, 2, 3, 4, 9, 10, 11, 12], debris: 5, omega: 13 };
const listeners = [];
// paper is white
let isPrinting = false;

export function isDark() {
  if (isPrinting) return false;
  const chosen = document.documentElement.dataset.theme;
  return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
}

// Whether the page is being printed.
export function isOnPaper() {
  return isPrinting;
}

// Colours of a figure; `dark` says for which background.
export function colors(dark = isDark()) {
  const text = dark ? "#e8e8e8" : "#1a1a1a";
  const quiet = dark ? "#a8a8a8" : "#5c5c5c";
  const hues = [...(dark ? HUES_ON_DARK : HUES), text, quiet, ...(dark ? MORE_ON_DARK : MORE)];
  return { hues, text, quiet, grid: dark ? "#333333" : "#e6e6e6", background: dark ? "#161616" : "#ffffff" };
}

export function onTheme(listener) {
  listeners.push(listener);
}

export function startTheme(button) {
  const show = () => {
    button.textContent = isDark() ? "light" : "dark";
    button.setAttribute("aria-label", `Switch to a ${button.textContent} page`);
    for (const listener of listeners) listener();
  };
  button.hidden = false;
  button.addEventListener("click", () => {
    document.documentElement.dataset.theme = isDark() ? "light" : "dark";
    show();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", show);
  const print = (starts) => () => {
    isPrinting = starts;
    show();
  };
  addEventListener("beforeprint", print(true));
  addEventListener("afterprint", print(false));
  show();
}
