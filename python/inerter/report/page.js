(function () {
  "use strict";
  const read = (id) => JSON.parse(document.getElementById(id).textContent);
  const palette = read("palette");
  const plots = read("plots");
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const places = Array.from(document.querySelectorAll("[data-plot]"));
  const picker = document.getElementById("run");
  // a finger that scrolls the page must not zoom a plot
  const coarse = window.matchMedia("(pointer: coarse)").matches;
  const config = { responsive: true, displaylogo: false, displayModeBar: false };

  // plots come in light colours; exchange each for its partner
  const partners = {};
  for (const name of Object.keys(palette.light)) partners[palette.light[name]] = palette.dark[name];
  function coloured(value) {
    if (typeof value === "string") return partners[value] || value;
    if (Array.isArray(value)) return value.map(coloured);
    if (value && typeof value === "object") {
      const copy = {};
      for (const key of Object.keys(value)) copy[key] = coloured(value[key]);
      return copy;
    }
    return value;
  }

  function figureOf(place) {
    const run = plots.runs[picker ? Number(picker.value) : 0] || {};
    return plots.single[place] || run[place];
  }

  function draw(paper) {
    for (const place of places) {
      const made = figureOf(place.dataset.plot);
      if (!made) continue;
      // plotly writes into what it is given
      const own = dark.matches && !paper ? coloured(made) : JSON.parse(JSON.stringify(made));
      if (coarse) own.layout.dragmode = false;
      if (paper) own.layout.width = place.dataset.plot === "time" ? 660 : 320;
      Plotly.react(place, own.data, own.layout, config);
    }
  }

  // copying without the clipboard interface, which pages opened from a file may lack
  function copy(button) {
    const range = document.createRange();
    range.selectNodeContents(document.getElementById(button.dataset.copy));
    const selection = window.getSelection();
    selection.removeAllRanges();
    selection.addRange(range);
    const done = document.execCommand("copy");
    button.textContent = done ? "Copied" : "Press Ctrl+C";
    setTimeout(() => { button.textContent = "Copy"; }, 2500);
  }

  for (const button of document.querySelectorAll(".copy")) {
    button.addEventListener("click", () => copy(button));
  }
  if (picker) {
    // browsers remember the choice over a reload
    picker.addEventListener("change", () => draw(false));
  }
  dark.addEventListener("change", () => draw(false));
  window.addEventListener("beforeprint", () => draw(true));
  window.addEventListener("afterprint", () => draw(false));
  draw(false);
})();
