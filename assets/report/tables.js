// Tables that can be sorted and searched, answers that open to their figures, and texts that can be copied.

function sortBy(table, column, ascending) {
  const body = table.tBodies[0];
  const key = (row) => {
    const cell = row.cells[column];
    return cell.dataset.value === undefined ? cell.textContent : Number(cell.dataset.value);
  };
  const order = (a, b) => {
    const [left, right] = [key(a), key(b)];
    if (typeof left === typeof right) return typeof left === "number" ? left - right : left.localeCompare(right);
    return typeof left === "number" ? -1 : 1;
  };
  const rows = Array.from(body.rows).sort((a, b) => (ascending ? order(a, b) : order(b, a)));
  body.append(...rows);
}

function makeSortable(table) {
  Array.from(table.tHead.rows[0].cells).forEach((head, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const ascending = head.getAttribute("aria-sort") !== "ascending";
      for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
      sortBy(table, column, ascending);
    });
  });
}

function makeSearchable(table) {
  const input = document.createElement("input");
  input.type = "search";
  input.placeholder = "Search observables";
  input.setAttribute("aria-label", "Search observables");
  input.addEventListener("input", () => {
    const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const row of table.tBodies[0].rows) {
      const text = `${row.cells[0].textContent} ${row.cells[0].title}`.toLowerCase();
      row.hidden = !words.every((word) => text.includes(word));
    }
  });
  table.parentElement.before(input);
}

// An answer that opens shows its large figure, which goes back to its section when it closes.
export function startAnswers(redraw) {
  const homes = new Map();
  for (const row of document.querySelectorAll("details.answer")) {
    const place = row.querySelector("[data-shows]");
    row.addEventListener("toggle", () => {
      const figure = place && document.getElementById(place.dataset.shows);
      if (!figure) return;
      if (!homes.has(figure)) homes.set(figure, document.createComment(""));
      const home = homes.get(figure);
      if (!home.isConnected) figure.before(home);
      if (row.open) place.append(figure);
      else if (place.contains(figure)) home.after(figure);
      redraw();
    });
  }
}

export function startTables() {
  document.querySelectorAll("table.sortable").forEach(makeSortable);
  document.querySelectorAll("table.searchable").forEach(makeSearchable);
  for (const button of document.querySelectorAll("[data-copy]")) {
    button.addEventListener("click", async () => {
      const text = button.textContent;
      try {
        await navigator.clipboard.writeText(button.dataset.copy);
        button.textContent = "copied";
      } catch {
        button.textContent = button.dataset.copy;
        return;
      }
      setTimeout(() => (button.textContent = text), 1200);
    });
  }
}
