// Laws of the page around its figures: without scripts, menu, inputs, tables, narrow, on paper.

import { opened, problems } from "./open_page.mjs";

export async function checkWithoutScripts(browser, file, name) {
  const page = await opened(browser, file, { width: 1300, height: 900 }, "light", false);
  const text = await page.evaluate(() => document.body.innerText);
  for (const part of ["computed", "spindrift", "Statistics"]) if (!text.includes(part)) problems.push(`${name}: without scripts there is no "${part}"`);
  const rows = await page.$$eval("details.answer", (list) => list.map((row) => row.getBoundingClientRect().bottom));
  if (rows.length === 0) problems.push(`${name}: there is no answer`);
  if (rows.slice(0, 6).some((bottom) => bottom > 900)) problems.push(`${name}: one of the first six answers is below the first screen`);
  await page.close();
}

// Each link of the menu ends with the heading of its section below the menu, though figures above are drawn on the way; and the menu is one line.
export async function checkLinks(page, name) {
  const menu = await page.$eval("nav", (nav) => nav.getBoundingClientRect().height);
  if (menu > 60) problems.push(`${name}: the menu is ${menu} pixels high`);
  for (const link of await page.$$("nav a")) {
    const anchor = await link.evaluate((element) => element.hash.slice(1));
    await link.evaluate((element) => element.click());
    let top = Infinity;
    for (let tries = 0; tries < 40; tries += 1) {
      await new Promise((resolve) => setTimeout(resolve, 100));
      const now = await page.$eval(`#${anchor}`, (section) => section.getBoundingClientRect().top);
      if (Math.abs(now - top) < 0.5) break;
      top = now;
    }
    const isEnd = await page.evaluate(() => scrollY + innerHeight > document.documentElement.scrollHeight - 4);
    const below = await page.$eval("nav", (nav) => (nav.getBoundingClientRect().top < 2 ? nav.getBoundingClientRect().bottom : 0));
    const heading = await page.$eval(`#${anchor} h2`, (element) => element.getBoundingClientRect().top);
    if (!isEnd && (heading < below - 1 || heading > below + 120)) problems.push(`${name}: the link to ${anchor} ends ${Math.round(heading - below)} pixels below the menu`);
  }
}

// An input is one line: a small histogram, nominal value, distribution and fit; it opens to its figure.
export async function checkInputs(page, name) {
  const rows = await page.$$eval("details.input", (list) => list.map((row) => ({ height: row.querySelector("summary").getBoundingClientRect().height, bars: row.querySelectorAll("svg.small rect").length, text: row.innerText, figures: row.querySelectorAll("figure").length })));
  // what an open line shows does not reach into the next one
  const over = await page.$$eval("details.input[open] figcaption", (list) => list.filter((caption) => caption.getBoundingClientRect().bottom > caption.closest("details").getBoundingClientRect().bottom + 1).map((caption) => caption.textContent));
  if (over.length > 0) problems.push(`${name}: a caption of an input is over the next line: ${over[0]}`);
  for (const { height, bars, text, figures } of rows) if (height > 60 || (bars < 1 && !/(^|\D)0 dispersed/.test(text)) || figures !== 1) problems.push(`${name}: the line of an input is ${height} pixels high with ${bars} bars and ${figures} figures: ${text}`);
}

export async function checkTables(page, name) {
  const search = await page.$("input[type=search]");
  if (!search) return;
  const rows = () => page.$$eval("#statistics tbody tr", (list) => list.filter((row) => !row.hidden).length);
  const all = await rows();
  await search.type("energy");
  const some = await rows();
  if (some === 0 || some >= all) problems.push(`${name}: searching "energy" leaves ${some} of ${all} rows`);
  await page.$eval("input[type=search]", (input) => {
    input.value = "";
    input.dispatchEvent(new Event("input"));
  });
  await page.click("#statistics thead th:nth-child(2) button");
}

// No table is cut: it has room for all of its cells, or is in a box that scrolls and whose edge says so; the worst runs have room. Folded ones too.
export async function checkNarrowTables(page, name) {
  const wrong = await page.evaluate(() => {
    for (const details of document.querySelectorAll("details")) details.open = true;
    const width = document.documentElement.clientWidth;
    const found = document.documentElement.scrollWidth > width ? [`the page is ${document.documentElement.scrollWidth} pixels wide`] : [];
    for (const table of document.querySelectorAll("table")) {
      const what = table.closest("section")?.id ?? "a table";
      const box = table.closest(".table");
      const style = box ? getComputedStyle(box) : null;
      const scrolls = style?.overflowX === "auto" && style.backgroundImage !== "none" && box.getBoundingClientRect().right <= width + 1;
      const right = Math.max(...Array.from(table.querySelectorAll("th, td"), (cell) => cell.getBoundingClientRect().right));
      if (right > width + 1 && (what === "worst" || !scrolls)) found.push(`${what} is cut at ${width} of ${right} pixels`);
      const cut = Array.from(table.querySelectorAll("th, td")).find((cell) => cell.clientWidth > 0 && (cell.scrollWidth > cell.clientWidth + 1 || cell.scrollHeight > cell.clientHeight + 1));
      if (cut) found.push(`a cell of ${what} is cut: ${cut.innerText}`);
    }
    return found;
  });
  problems.push(...wrong.map((text) => `${name}: ${text}`));
}

// On paper nothing can be opened: no caption is cut, no answer loses an edge, no word of a picture stands on another, and what only a screen needs is not there.
export async function checkPaper(page, name) {
  await page.setViewport({ width: 718, height: 1000 }); // A4 less its margins
  await page.emulateMediaType("print");
  const wrong = await page.evaluate(() => {
    const found = [];
    const isSeen = (element) => element.getClientRects().length > 0;
    for (const caption of document.querySelectorAll("figcaption")) {
      const style = getComputedStyle(caption);
      if (isSeen(caption) && (style.display === "-webkit-box" || style.overflow !== "visible" || caption.scrollHeight > caption.clientHeight + 1)) found.push(`a caption is cut: ${caption.textContent}`);
    }
    for (const text of document.querySelectorAll("main p, .beside p")) if (isSeen(text) && /needs JavaScript/.test(text.textContent)) found.push(`it says "${text.textContent}"`);
    const width = document.documentElement.clientWidth;
    for (const row of document.querySelectorAll("details.answer")) {
      const box = row.getBoundingClientRect();
      if (box.height < 10) found.push(`the answer ${row.id} is not printed`);
      if (box.right > width) found.push(`the edge of an answer is at ${box.right} of ${width}`);
      for (const picture of row.querySelectorAll("summary svg.scale, summary svg.small")) {
        const texts = Array.from(picture.querySelectorAll("text"), (text) => text.getBoundingClientRect());
        if (texts.some((a, i) => texts.some((b, j) => i < j && Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 2))) found.push(`words of a picture stand on each other: ${picture.textContent}`);
      }
    }
    return found;
  });
  problems.push(...wrong.slice(0, 8).map((text) => `${name}: on paper: ${text}`));
  await page.emulateMediaType(null);
  await page.setViewport({ width: 1300, height: 900 });
}
