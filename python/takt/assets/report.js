"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const el = (tag, properties = {}, ...children) => {
    const node = Object.assign(document.createElement(tag), properties);
    node.append(...children);
    return node;
  };
  const put = (id, ...children) => document.getElementById(id).append(...children);

  // --- columns ---

  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
  const unpack = (field, n) => {
    if ("constant" in field) return new Array(n).fill(field.constant);
    if ("i8" in field) return new Int8Array(bytes(field.i8));
    const values = "f32" in field ? new Float32Array(bytes(field.f32)) : new Float64Array(bytes(field.f64));
    return values.some(Number.isNaN) ? Array.from(values, (v) => (Number.isFinite(v) ? v : null)) : values;
  };
  const times = data.bases.map((base) => {
    if (!("from" in base)) return unpack(base, base.n);
    const step = (base.to - base.from) / (base.n - 1);
    return Float64Array.from({ length: base.n }, (_, i) => base.from + i * step);
  });

  // --- head, figures, tables ---

  document.querySelector("h1").textContent = data.title;
  const failed = data.verdicts.filter((v) => !v.passed).length;
  const pill = document.getElementById("pill");
  pill.className = `pill ${failed ? "bad" : "good"}`;
  pill.textContent = !data.verdicts.length ? "no verdicts" : failed ? `${failed} of ${data.verdicts.length} failed` : `all ${data.verdicts.length} passed`;
  if (!data.verdicts.length) pill.className = "pill";

  const show = (value) => (value === null ? "—" : Array.isArray(value) ? value.join(", ") : String(value));
  const isGroup = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
  const facts = { made: data.made };
  if (data.span[0] !== null) facts.length = `${(data.span[1] - data.span[0]).toFixed(3)} s`;
  for (const [name, value] of Object.entries({ ...data.meta, ...facts })) {
    if (!isGroup(value)) put("facts", el("div", {}, el("dt", { textContent: name }), el("dd", { textContent: show(value) })));
  }
  for (const [name, group] of Object.entries(data.meta).filter(([, value]) => isGroup(value))) {
    const cards = Object.entries(group).map(([what, value]) =>
      el("div", { className: "figure" }, el("b", { textContent: isGroup(value) ? JSON.stringify(value) : show(value) }), el("span", { textContent: what })));
    put("figures", el("div", { className: "group" }, el("h2", { textContent: name }), el("div", { className: "cards" }, ...cards)));
  }

  if (!data.verdicts.length) document.getElementById("verdicts-section").remove();
  const verdictRows = data.verdicts.map((verdict) => {
    const row = el("tr", { className: verdict.passed ? "good" : "bad", tabIndex: 0 },
      ...[verdict.passed ? "passed" : "failed", verdict.title, verdict.sentence, verdict.when ?? ""].map((t) => el("td", { textContent: t })));
    row.onclick = () => choose(verdict, row);
    row.onkeydown = (event) => { if (event.key === "Enter") choose(verdict, row); };
    return row;
  });
  document.querySelector("#verdicts tbody")?.append(...verdictRows);

  if (!data.summary.rows.length) document.getElementById("summary-section").remove();
  document.querySelector("#summary thead")?.append(el("tr", {}, ...data.summary.head.map((t) => el("th", { textContent: t }))));
  document.querySelector("#summary tbody")?.append(
    ...data.summary.rows.map((row) => el("tr", {}, ...row.map((t) => el("td", { textContent: t })))));

  // --- curves ---

  const AXIS_PX = 62;
  const plots = [];  // {plot, node, seen, stale}
  let chosen = null;
  let range = [...data.span];

  const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
  const mix = (a, b, share) => {
    const [x, y] = [rgb(a), rgb(b)];
    return `rgb(${x.map((v, i) => Math.round(v * (1 - share) + y[i] * share)).join()})`;
  };
  const tone = (component, field, pair) => (field.set && pair ? mix(component.colour, css("--ink"), 0.55) : component.colour);
  const digits = (v) => (v === null || v === undefined ? "—" : Math.abs(v) >= 1e5 || (v && Math.abs(v) < 1e-3) ? v.toExponential(2) : String(+v.toPrecision(6)));

  function zoom(from, to) {
    range = [from, to];
    for (const item of plots) item.stale = true;
    refresh();
  }
  function refresh() {
    for (const item of plots) {
      if (!item.seen || !item.stale) continue;
      item.stale = false;
      item.plot.setScale("x", { min: range[0], max: range[1] });
    }
  }
  const observer = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      const item = plots.find((p) => p.node === entry.target);
      if (item) item.seen = entry.isIntersecting;
    }
    refresh();
  }, { rootMargin: "400px" });

  // Marks and places behind the curves of a lane.
  function background(component, lane) {
    const events = data.events.filter((e) => e[1] === component.name || e[1] === "");
    return (u) => {
      const { ctx } = u;
      const { left, top, width, height } = u.bbox;
      ctx.save();
      ctx.beginPath();
      ctx.rect(left, top, width, height);
      ctx.clip();
      for (const verdict of data.verdicts) {
        if (!verdict.place || !verdict.components.includes(component.name)) continue;
        if (verdict !== chosen && verdict.passed) continue;
        const [a, b] = verdict.place.map((t) => u.valToPos(t, "x", true));
        ctx.fillStyle = verdict.passed ? css("--good") : css("--bad");
        ctx.globalAlpha = verdict === chosen ? 0.2 : 0.09;
        ctx.fillRect(a - 1, top, Math.max(b - a, 0) + 2, height);
      }
      ctx.globalAlpha = 0.4;
      ctx.lineWidth = devicePixelRatio;
      ctx.setLineDash([]);
      for (const [time, , , kind] of events) {
        const x = Math.round(u.valToPos(time, "x", true)) + 0.5;
        ctx.strokeStyle = kind === "error" ? css("--bad") : css("--soft");
        ctx.beginPath();
        ctx.moveTo(x, top);
        ctx.lineTo(x, top + height);
        ctx.stroke();
      }
      if (chosen && lane && chosen.components.includes(component.name)) {
        ctx.globalAlpha = 0.9;
        ctx.strokeStyle = css("--bad");
        ctx.setLineDash([6 * devicePixelRatio, 4 * devicePixelRatio]);
        for (const bound of chosen.bounds) {
          if (bound.quantity !== lane.quantity || bound.unit !== lane.unit) continue;
          const y = Math.round(u.valToPos(bound.level, "y", true)) + 0.5;
          ctx.beginPath();
          ctx.moveTo(left, y);
          ctx.lineTo(left + width, y);
          ctx.stroke();
        }
      }
      ctx.restore();
    };
  }

  const font = (px) => `${px * devicePixelRatio}px ${getComputedStyle(document.body).fontFamily}`;

  // Labels of the marks, in two rows, as many as there is room for.
  function markLabels(component) {
    const events = data.events.filter((e) => e[1] === component.name || e[1] === "");
    return (u) => {
      const { ctx } = u;
      const free = [-Infinity, -Infinity];
      ctx.save();
      ctx.font = font(11.5);
      ctx.textBaseline = "middle";
      ctx.textAlign = "left";
      for (const [time, , text, kind] of events) {
        const x = u.valToPos(time, "x", true);
        if (x < u.bbox.left - 1 || x > u.bbox.left + u.bbox.width) continue;
        const row = free.findIndex((until) => until <= x);
        if (row < 0) continue;
        free[row] = x + ctx.measureText(text).width + 14 * devicePixelRatio;
        ctx.fillStyle = kind === "error" ? css("--bad") : kind === "end" ? css("--soft") : css("--ink");
        ctx.fillText(text, x + 4 * devicePixelRatio, u.bbox.top + (9 + 16 * row) * devicePixelRatio);
      }
      ctx.restore();
    };
  }

  function bands(fields, time) {
    const rows = fields.map((field) => {
      const stretches = [];
      for (let i = 0, from = 0; i < time.length; i++) {
        if (i === time.length - 1 || field.values[i + 1] !== field.values[i]) {
          stretches.push([time[from], time[Math.min(i + 1, time.length - 1)], field.values[i]]);
          from = i + 1;
        }
      }
      return stretches;
    });
    return (u) => {
      const { ctx } = u;
      const { left, top, width, height } = u.bbox;
      const each = height / rows.length;
      ctx.save();
      ctx.beginPath();
      ctx.rect(left, top, width, height);
      ctx.clip();
      ctx.font = "600 " + font(11);
      ctx.textAlign = "center";
      ctx.textBaseline = "middle";
      rows.forEach((stretches, row) => {
        for (const [from, to, value] of stretches) {
          const known = fields[row].names[value];
          if (!known && value === 0) continue;
          const [name, colour] = known ?? [`?${value}`, "#8b939e"];
          const a = Math.max(u.valToPos(from, "x", true), left);
          const b = Math.min(u.valToPos(to, "x", true), left + width);
          if (b <= a) continue;
          ctx.fillStyle = colour;
          ctx.fillRect(a, top + row * each + 2, b - a, each - 4);
          if (ctx.measureText(name).width + 10 < b - a) {
            ctx.fillStyle = "#ffffff";
            ctx.fillText(name, (a + b) / 2, top + (row + 0.5) * each);
          }
        }
      });
      ctx.restore();
    };
  }

  // Where a rotary position wraps, its curve is not joined.
  function wraps(values, modulus) {
    const jumps = [];
    for (let i = 1; i < values.length; i++) if (Math.abs(values[i] - values[i - 1]) > modulus / 2) jumps.push(i);
    return (u, _, from, to, gaps) => {
      const more = jumps.filter((i) => i > from && i <= to)
        .map((i) => [u.data[0][i - 1], u.data[0][i]].map((t) => Math.round(u.valToPos(t, "x", true))));
      return gaps.concat(more).sort((a, b) => a[0] - b[0]);
    };
  }

  function showTime(u) {
    const time = u.cursor.idx == null ? null : u.data[0][u.cursor.idx];
    if (time !== null) document.getElementById("time").textContent = `${time.toFixed(4)} s`;
  }

  function addPlot(host, lane, { height, series, columns, time, hooks, yAxis, last, yRange }) {
    const cell = el("div");
    host.append(cell);
    const line = { stroke: () => css("--grid"), width: 1 };
    const options = {
      width: Math.max(cell.clientWidth, 200),
      height: height + (last ? 30 : 0),
      legend: { show: false },
      padding: [last ? 2 : 8, 18, last ? 0 : 4, 0],
      cursor: { sync: { key: "takt" }, points: { size: 6 }, drag: { x: true, y: false, setScale: false }, bind: { dblclick: () => () => zoom(...data.span) } },
      scales: { x: { time: false, range: (_, a, b) => [a, b] }, y: yRange ? { range: yRange } : {} },
      axes: [
        { stroke: () => css("--soft"), grid: line, ticks: { show: !!last, ...line, size: 5 }, size: last ? 30 : 0, values: last ? undefined : (_, splits) => splits.map(() => "") },
        { stroke: () => css("--soft"), grid: { ...line, show: yAxis }, ticks: { ...line, size: 5, show: yAxis }, size: AXIS_PX, space: 24,
          values: (_, splits) => (yAxis ? splits.map((v) => digits(+v.toPrecision(10))) : splits.map(() => "")) },
      ],
      series: [{}, ...series],
      hooks: {
        ...hooks,
        setCursor: [showTime, ...(hooks.setCursor ?? [])],
        setSelect: [(u) => {
          if (u.select.width < 3) return;
          const ends = [u.select.left, u.select.left + u.select.width].map((x) => u.posToVal(x, "x"));
          u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
          zoom(...ends);
        }],
      },
    };
    const plot = new uPlot(options, [time, ...columns], cell);
    const item = { plot, node: cell, seen: true, stale: false };
    plots.push(item);
    observer.observe(cell);
    new ResizeObserver(() => {
      if (cell.clientWidth > 0 && cell.clientWidth !== plot.width) plot.setSize({ width: cell.clientWidth, height: options.height });
    }).observe(cell);
    return plot;
  }

  function addLane(block, component, lane, time, last) {
    const row = el("div", { className: "lane" });
    const legend = el("div", { className: "legend" }, el("strong", { textContent: lane.unit ? `${lane.quantity} [${lane.unit}]` : lane.quantity }));
    block.append(row);
    const pair = lane.fields.some((f) => f.set) && lane.fields.some((f) => !f.set);
    // Measured curves first, so that the dashed set points lie on top.
    const fields = [...lane.fields].sort((a, b) => a.set - b.set);
    const outputs = [];
    const plot = addPlot(row, lane, {
      height: lane.quantity === "position" ? 150 : 104,
      time,
      columns: fields.map((f) => f.values),
      series: fields.map((f) => ({
        label: f.label,
        stroke: () => tone(component, f, pair),
        width: f.set && pair ? 1.25 : 1.5,
        dash: f.set && pair ? [6, 4] : undefined,
        points: { show: false },
        ...(component.modulus && f.quantity === "position" ? { gaps: wraps(f.values, component.modulus) } : {}),
      })),
      hooks: {
        drawClear: [background(component, lane)],
        setCursor: [(u) => outputs.forEach((out, i) => { out.textContent = u.cursor.idx == null ? "" : digits(fields[i].values[u.cursor.idx]); })],
      },
      yAxis: true,
      last,
    });
    fields.forEach((field, i) => {
      const out = el("output");
      const line = el("i", { className: field.set && pair ? "dashed" : "" });
      line.style.borderColor = tone(component, field, pair);
      outputs.push(out);
      const button = el("button", { type: "button" }, line, el("span", { textContent: field.label }), out);
      button.onclick = () => {
        plot.setSeries(i + 1, { show: !plot.series[i + 1].show });
        button.classList.toggle("off", !plot.series[i + 1].show);
      };
      legend.append(button);
    });
    row.append(legend);
  }

  function addComponent(component) {
    const time = times[component.base];
    const block = el("article", { className: "component", id: `c-${component.name}` });
    const head = el("h3", {}, component.name);
    block.append(head);
    put("curves", block);
    if (time.length < 2) {
      head.append(el("small", { textContent: `${time.length} samples: nothing to draw` }));
      return block;
    }
    const still = component.fields.filter((f) => "constant" in f);
    const moving = component.fields.filter((f) => !("constant" in f));
    for (const field of moving) field.values = unpack(field, time.length);
    const states = moving.filter((f) => f.names);
    const lanes = new Map();
    for (const field of moving.filter((f) => !f.names)) {
      const key = `${field.quantity} ${field.unit}`;
      if (!lanes.has(key)) lanes.set(key, { quantity: field.quantity, unit: field.unit, fields: [] });
      lanes.get(key).fields.push(field);
    }
    const rank = (lane) => (data.quantities.indexOf(lane.quantity) + 99) % 99;
    const ordered = [...lanes.values()].sort((a, b) => rank(a) - rank(b));
    if (still.length) {
      const texts = still.map((f) => `${f.label} = ${digits(f.constant)}${f.unit ? " " + f.unit : ""}`);
      head.append(el("small", { textContent: `throughout: ${texts.join(", ")}` }));
    }
    const flat = { series: [{ paths: () => null, points: { show: false } }], yAxis: false, time, yRange: [0, 1] };
    if (data.events.some((e) => e[1] === component.name || e[1] === "")) {
      const row = el("div", { className: "lane" });
      block.append(row);
      addPlot(row, null, { ...flat, height: 40, columns: [new Array(time.length).fill(0)], hooks: { drawClear: [background(component, null)], draw: [markLabels(component)] } });
    }
    ordered.forEach((lane, i) => addLane(block, component, lane, time, !states.length && i === ordered.length - 1));
    if (states.length) {
      const row = el("div", { className: "lane" });
      block.append(row);
      const outputs = states.map(() => el("output"));
      addPlot(row, null, {
        ...flat, height: 28 * states.length, columns: [new Array(time.length).fill(0)], last: true,
        hooks: {
          drawClear: [background(component, null)],
          draw: [bands(states, time)],
          setCursor: [(u) => states.forEach((f, i) => { outputs[i].textContent = u.cursor.idx == null ? "" : f.names[f.values[u.cursor.idx]]?.[0] ?? String(f.values[u.cursor.idx]); })],
        },
      });
      row.append(el("div", { className: "legend" }, ...states.map((f, i) => el("div", {}, el("span", { textContent: f.label + "  " }), outputs[i]))));
    }
    return block;
  }

  function choose(verdict, row) {
    chosen = verdict;
    for (const other of verdictRows) other.classList.toggle("chosen", other === row);
    if (verdict.place) {
      const [from, to] = verdict.place;
      const room = Math.max(0.6 * (to - from), 0.015 * (data.span[1] - data.span[0]));
      zoom(Math.max(from - room, data.span[0]), Math.min(to + room, data.span[1]));
    } else {
      zoom(...data.span);
    }
    for (const { plot } of plots) plot.redraw(false);
    const first = blocks.get(verdict.components[0]);
    if (first) {
      if (first.hidden) chips.get(verdict.components[0]).click();
      first.scrollIntoView({ behavior: "smooth", block: "start" });
    }
  }

  const blocks = new Map();
  const chips = new Map();
  for (const component of data.components) {
    const block = addComponent(component);
    blocks.set(component.name, block);
    const dot = el("i");
    dot.style.background = component.colour;
    const chip = el("button", { type: "button", ariaPressed: "true" }, dot, component.name);
    chip.onclick = () => {
      block.hidden = !block.hidden;
      chip.ariaPressed = String(!block.hidden);
    };
    chips.set(component.name, chip);
    put("chips", chip);
  }
  document.getElementById("reset").onclick = () => zoom(...data.span);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { for (const { plot } of plots) plot.redraw(false); });

  // report.html#verdict=1 opens with the first verdict chosen.
  const wanted = /^#verdict=(\d+)$/.exec(location.hash);
  if (wanted && data.verdicts[wanted[1] - 1]) choose(data.verdicts[wanted[1] - 1], verdictRows[wanted[1] - 1]);
})();
