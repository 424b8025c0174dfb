// Notes at once instead of after a second, series that stand out, values under the pointer.
const tip = document.createElement("div");
tip.className = "tip";
tip.hidden = true;
document.body.append(tip);
function show(lines, event) {
  tip.hidden = lines.length === 0;
  if (tip.hidden) return;
  tip.replaceChildren(...lines.map(line => {
    const row = document.createElement("div");
    row.textContent = line;
    return row;
  }));
  const { width, height } = tip.getBoundingClientRect();
  const left = Math.min(event.clientX + 14, document.documentElement.clientWidth - width - 6);
  const below = event.clientY + 16;
  const top = below + height > innerHeight ? event.clientY - height - 12 : below;
  tip.style.left = `${Math.max(left, 6)}px`;
  tip.style.top = `${Math.max(top, 6)}px`;
}
for (const title of document.querySelectorAll(".plot svg g > title")) {
  title.parentNode.dataset.note = title.textContent;
  title.remove();
}
for (const svg of document.querySelectorAll(".plot > svg")) {
  const plot = svg.querySelector("[data-plot]");
  if (plot) follow(svg, plot);
  else svg.addEventListener("pointermove", event => {
    const noted = event.target.closest("[data-note]");
    show(noted ? [noted.dataset.note] : [], event);
  });
  svg.addEventListener("pointerleave", () => { tip.hidden = true; });
}
function follow(svg, plot) {
  const numbers = name => plot.dataset[name].split(" ").map(Number);
  const [left, top, width, height] = numbers("plot");
  const value = (name, share) => {
    const [low, high, log] = numbers(name);
    return log ? low * (high / low) ** share : low + share * (high - low);
  };
  const text = x => x === 0 ? "0" : String(Number(x.toPrecision(4)));
  const parts = [...plot.querySelectorAll("[data-series]")];
  const keys = [...plot.querySelectorAll("[data-key]")];
  const name = index => keys.find(key => key.dataset.key === index)?.textContent.trim() ?? "";
  const marks = parts.flatMap(part => [...part.querySelectorAll("[data-note]")].map(element => {
    const box = element.firstElementChild.getBBox();
    const at = [box.x + box.width / 2, box.y + box.height / 2];
    return { at, note: element.dataset.note, series: part.dataset.series };
  }));
  // Lines without marks have no notes; their places are read.
  const lines = plot.dataset.read !== "lines" ? [] : parts.map(part => ({
    series: part.dataset.series,
    points: [...part.querySelectorAll("path[fill=none]")].flatMap(path =>
      path.getAttribute("d").split(/[ML]/).slice(1).map(pair => pair.split(" ").map(Number))),
  })).filter(line => line.points.length);
  const pinned = new Set();
  const light = index => {
    const lit = new Set(pinned);
    if (index !== undefined) lit.add(index);
    plot.classList.toggle("dim", lit.size > 0);
    parts.forEach(part => part.classList.toggle("lit", lit.has(part.dataset.series)));
    keys.forEach(key => key.classList.toggle("lit", lit.has(key.dataset.key)));
  };
  const place = event => new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
  const away = (mark, at) => Math.hypot(mark.at[0] - at.x, mark.at[1] - at.y);
  const nearest = at => marks.reduce((best, mark) => !best || away(mark, at) < away(best, at) ? mark : best, undefined);
  const find = event => {
    const key = event.target.closest("[data-key]");
    if (key) return { series: key.dataset.key, lines: [] };
    const at = place(event);
    const mark = nearest(at);
    if (mark && away(mark, at) < 16) {
      // Marks upon one another are all named.
      const here = { x: mark.at[0], y: mark.at[1] };
      return { series: mark.series, lines: marks.filter(other => away(other, here) < 4).map(other => other.note) };
    }
    const [x, y] = [(at.x - left) / width, (at.y - top) / height];
    if (!lines.length || x < 0 || x > 1 || y < 0 || y > 1) return { lines: [] };
    const values = lines.map(line => {
      const point = line.points.reduce((best, point) => Math.abs(point[0] - at.x) < Math.abs(best[0] - at.x) ? point : best);
      return `${name(line.series)}: ${text(value("y", 1 - (point[1] - top) / height))}`;
    });
    return { lines: [`${plot.dataset.over}: ${text(value("x", x))}`, ...values] };
  };
  svg.addEventListener("pointermove", event => {
    const found = find(event);
    light(found.series);
    show(found.lines, event);
  });
  svg.addEventListener("pointerleave", () => light());
  svg.addEventListener("click", event => {
    const { series } = find(event);
    if (series === undefined) pinned.clear();
    else if (!pinned.delete(series)) pinned.add(series);
    light(series);
  });
}
