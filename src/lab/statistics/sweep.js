'use strict';
(() => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const byId = (id) => document.getElementById(id);
  // Places in a method's list, as sweep_page.cpp writes them.
  const METHOD = 0, COUNT = 1, MEAN = 2, MEDIAN = 5, P95 = 8, WORST = 11, WRONG = 12, TEXELS = 15, BUILD = 16, SHADE = 17, FRAME = 18;
  const subsets = new Map(data.subsets.map((subset) => [subset.at.join(), subset]));
  const subsetAt = (scene, map, size) => subsets.get([scene, map, size].join());
  const percent = (share) => {
    if (share === null || share === undefined) return '';
    const p = 100 * share, size = Math.abs(p);
    if (p === 0) return '0';
    if (size < 0.0005) return p.toExponential(0);
    return p.toFixed(size >= 10 ? 1 : size >= 1 ? 2 : size >= 0.1 ? 3 : 4);
  };
  const make = (name, attributes = {}, text = null) => {
    const isSvg = ['svg', 'g', 'circle', 'path', 'line', 'text', 'title', 'rect'].includes(name);
    const element = isSvg ? document.createElementNS('http://www.w3.org/2000/svg', name) : document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    if (text !== null) element.textContent = text;
    return element;
  };
  const fill = (parent, ...children) => { parent.replaceChildren(...children); return parent; };
  const choice = { scene: -1, map: -1, size: -1 };
  let sortBy = MEAN, ascending = true;

  // Hues around the circle, by the golden angle: neighbours in the list differ most.
  const colour = (method) => `hsl(${(method * 137.5) % 360} 55% ${45 + 12 * (method % 2)}%)`;

  function ranking() {
    const subset = subsetAt(choice.scene, choice.map, choice.size);
    byId('count').textContent = subset ? `${subset.cases} cases` : 'no cases';
    if (!subset) return fill(byId('ranking'));
    const columns = [['cases', COUNT], ['mean, %', MEAN, true], ['median, %', MEDIAN, true], ['95th, %', P95, true],
      ['worst, %', WORST], ['all wrong, %', WRONG, true], ['map ms', BUILD], ['look-up ms', SHADE], ['frame ms', FRAME]];
    const rows = [...subset.methods].sort((a, b) => (ascending ? 1 : -1) * ((a[sortBy] ?? Infinity) - (b[sortBy] ?? Infinity)));
    const head = make('tr');
    head.append(make('th', {}, 'method'));
    for (const [title, at] of columns) {
      const cell = make('th', at === sortBy ? { 'aria-sort': ascending ? 'ascending' : 'descending' } : {});
      const button = make('button', { type: 'button' }, title);
      button.addEventListener('click', () => { ascending = at === sortBy ? !ascending : true; sortBy = at; ranking(); });
      cell.append(button);
      head.append(cell);
    }
    const body = make('tbody');
    for (const row of rows) {
      const line = make('tr');
      line.append(make('th', {}, data.methods[row[METHOD]]));
      for (const [title, at, hasInterval] of columns) {
        const isTime = title.endsWith('ms');
        const value = row[at];
        const cell = make('td', {}, value === null ? '' : at === COUNT ? value : isTime ? value.toPrecision(3) : percent(value));
        if (hasInterval && row[at + 1] !== null) cell.append(make('small', {}, `[${percent(row[at + 1])}, ${percent(row[at + 2])}]`));
        line.append(cell);
      }
      body.append(line);
    }
    const table = make('table');
    table.append(make('thead'), body);
    table.tHead.append(head);
    return fill(byId('ranking'), fill(make('div', { class: 'scroll' }), table));
  }

  // Of what is chosen, as data.pairs has them of the whole; without intervals.
  function chosenPairs(order) {
    const fits = (wanted, value) => wanted < 0 || wanted === value;
    const cases = data.cases.filter((one) => fits(choice.scene, one[0]) && fits(choice.map, one[1]) && fits(choice.size, one[2]));
    const list = [];
    order.forEach((a, place) => order.slice(place + 1).forEach((b) => {
      let both = 0, wins = 0, losses = 0, sum = 0;
      for (const one of cases) {
        const errorOfA = one[3 + a], errorOfB = one[3 + b];
        if (errorOfA === null || errorOfB === null) continue;
        ++both;
        wins += errorOfA < errorOfB;
        losses += errorOfB < errorOfA;
        sum += errorOfB - errorOfA;
      }
      if (both) list.push([a, b, both, wins, losses, sum / both, null, null]);
    }));
    return list;
  }

  function pairs() {
    const isAll = choice.scene < 0 && choice.map < 0 && choice.size < 0, isOfAll = isAll || !data.cases;
    const subset = isOfAll ? subsetAt(-1, -1, -1) : subsetAt(choice.scene, choice.map, choice.size);
    byId('pairs-of').textContent = isAll ? 'over all scenes, maps and sizes' : !data.cases ? 'over all scenes, maps and sizes, whatever is chosen above' : subset?.cases === 1 ? 'over the one case chosen above' : `over the ${subset?.cases ?? 0} cases chosen above`;
    byId('pairs-sure').textContent = isOfAll ? 'Bold: the 95% interval of the mean difference is above 0.' : 'The 95% interval of the mean difference is told over all cases alone.';
    const order = (subset?.methods ?? []).map((row) => row[METHOD]);
    const found = new Map();
    for (const [a, b, cases, wins, losses, difference, lower, upper] of isOfAll ? data.pairs : chosenPairs(order)) {
      const range = lower === null ? '' : ` (${percent(lower)} to ${percent(upper)})`;
      const text = `${data.methods[a]} is better than ${data.methods[b]} in ${wins} of ${cases} cases, worse in ${losses}; mean difference ${percent(difference)}%${range}`;
      found.set(`${a},${b}`, { share: wins / Math.max(wins + losses, 1), text, sure: lower !== null && lower > 0 });
      found.set(`${b},${a}`, { share: losses / Math.max(wins + losses, 1), text, sure: false });
    }
    const head = make('tr');
    head.append(make('th', {}, ''), ...order.map((method) => make('th', {}, data.methods[method])));
    const body = make('tbody');
    for (const a of order) {
      const line = make('tr');
      line.append(make('th', {}, data.methods[a]));
      for (const b of order) {
        const pair = found.get(`${a},${b}`);
        const cell = make('td', pair ? { title: pair.text, style: `background: hsl(205 65% 50% / ${(0.85 * pair.share).toFixed(2)})${pair.sure ? '; font-weight: 650' : ''}` } : {},
          pair ? Math.round(100 * pair.share) : '');
        line.append(cell);
      }
      body.append(line);
    }
    const table = make('table');
    table.append(fill(make('thead'), head), body);
    fill(byId('pairs'), table);
  }

  function plot(id, at, unit) {
    const points = [];
    data.maps.forEach((map, m) => data.sizes.forEach((size, s) => {
      if ((choice.map >= 0 && choice.map !== m) || (choice.size >= 0 && choice.size !== s)) return;
      for (const row of subsetAt(choice.scene, m, s)?.methods ?? [])
        if (row[at] !== null && row[at] > 0) points.push({ method: row[METHOD], text: `${data.methods[row[METHOD]]}, ${map} ${size}`, cost: row[at], error: row[MEAN] });
    }));
    if (!points.length) return fill(byId(id), make('p', { class: 'note' }, 'Nothing was timed.'));
    for (const p of points) p.front = !points.some((q) => q.cost <= p.cost && q.error <= p.error && (q.cost < p.cost || q.error < p.error));
    const width = 1200, height = 460, left = 70, right = 20, top = 14, bottom = 44, strip = 26;
    const errors = points.map((p) => p.error).filter((e) => e > 0);
    const low = errors.length ? Math.floor(Math.log10(Math.min(...errors))) : -3, high = errors.length ? Math.ceil(Math.log10(Math.max(...errors)) + 1e-9) : 0;
    const costs = points.map((p) => Math.log10(p.cost)), from = Math.min(...costs) - 0.05, to = Math.max(...costs) + 0.05;
    const x = (cost) => left + (width - left - right) * (Math.log10(cost) - from) / (to - from);
    const y = (error) => error > 0 ? top + (height - top - bottom - strip) * (high - Math.log10(error)) / Math.max(high - low, 1) : height - bottom - strip / 3;
    const svg = make('svg', { viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': `error against ${unit}` });
    for (let decade = low; decade <= high; ++decade) {
      svg.append(make('line', { class: 'grid', x1: left, x2: width - right, y1: y(10 ** decade), y2: y(10 ** decade) }));
      svg.append(make('text', { x: left - 8, y: y(10 ** decade) + 4, 'text-anchor': 'end' }, `${percent(10 ** decade)}%`));
    }
    svg.append(make('text', { x: left - 8, y: y(0) + 4, 'text-anchor': 'end' }, '0'));
    for (let decade = Math.floor(from); decade <= Math.ceil(to); ++decade)
      for (const step of to - from < 1 ? [1, 1.5, 2, 3, 4, 5, 7] : [1, 2, 5]) {
        const cost = step * 10 ** decade;
        if (Math.log10(cost) < from || Math.log10(cost) > to) continue;
        const text = cost >= 1e6 ? `${cost / 1e6} M` : cost >= 1e3 ? `${cost / 1e3} k` : `${+cost.toPrecision(2)}`;
        svg.append(make('text', { x: x(cost), y: height - bottom + 20, 'text-anchor': 'middle' }, text));
      }
    svg.append(make('text', { x: (left + width - right) / 2, y: height - 6, 'text-anchor': 'middle' }, unit));
    const front = points.filter((p) => p.front).sort((a, b) => a.cost - b.cost);
    svg.append(make('path', { class: 'front', d: 'M' + front.map((p) => `${x(p.cost).toFixed(1)} ${y(p.error).toFixed(1)}`).join(' L') }));
    for (const p of [...points].sort((a, b) => a.front - b.front)) {
      const mark = make('circle', { cx: x(p.cost), cy: y(p.error), r: p.front ? 5.5 : 4, fill: p.front ? colour(p.method) : 'none', stroke: colour(p.method), 'stroke-width': 1.5 });
      mark.append(make('title', {}, `${p.text}: ${percent(p.error)}%, ${+p.cost.toPrecision(4)} ${unit}`));
      svg.append(mark);
    }
    // Beside its mark where there is room, else the title tells.
    const taken = [];
    for (const p of front) {
      const anchor = x(p.cost) > width - 260 ? 'end' : 'start';
      const box = { x: x(p.cost) + (anchor === 'end' ? -8 - 6.6 * p.text.length : 8), y: y(p.error) - 14, w: 6.6 * p.text.length, h: 16 };
      if (taken.some((other) => box.x < other.x + other.w && other.x < box.x + box.w && box.y < other.y + other.h && other.y < box.y + box.h)) continue;
      taken.push(box);
      svg.append(make('text', { class: 'label', x: x(p.cost) + (anchor === 'end' ? -9 : 9), y: y(p.error) - 3, 'text-anchor': anchor }, p.text));
    }
    return fill(byId(id), svg);
  }

  function heat() {
    const scenes = data.scenes.map((name, s) => s).filter((s) => choice.scene < 0 || choice.scene === s);
    const order = (subsetAt(choice.scene, choice.map, choice.size)?.methods ?? []).map((row) => row[METHOD]);
    const cells = new Map();
    for (const s of scenes) for (const row of subsetAt(s, choice.map, choice.size)?.methods ?? []) cells.set(`${row[METHOD]},${s}`, row[MEAN]);
    const values = [...cells.values()].filter((v) => v > 0).map(Math.log10);
    const low = Math.max(Math.min(...values), -6), high = Math.max(...values, low + 1e-9);
    const head = make('tr');
    head.append(make('th', {}, ''), ...scenes.map((s) => make('th', {}, data.scenes[s])));
    const body = make('tbody');
    for (const method of order) {
      const line = make('tr');
      line.append(make('th', {}, data.methods[method]));
      for (const s of scenes) {
        const value = cells.get(`${method},${s}`);
        const depth = value > 0 ? Math.max((Math.log10(value) - low) / (high - low), 0.03) : 0;
        line.append(make('td', value === undefined ? {} : { style: `background: hsl(22 90% 50% / ${(0.8 * depth).toFixed(2)})` }, percent(value)));
      }
      body.append(line);
    }
    const table = make('table');
    table.append(fill(make('thead'), head), body);
    fill(byId('heat'), table);
  }

  function worst() {
    const method = Number(byId('method').value);
    const all = data.worst.filter((one) => one.method === method);
    const isChosen = (one) => (choice.scene < 0 || one.scene === data.scenes[choice.scene]) && (choice.size < 0 || one.size === data.sizes[choice.size]) &&
      (choice.map < 0 || one.map === data.maps[choice.map].split(' ')[0]);
    const shown = all.filter(isChosen);
    fill(byId('worst'), ...shown.map((one) => {
      const box = make('div', { class: 'case' });
      if (one.picture) box.append(make('img', { src: data.pictures[one.picture], alt: `exact shadow and labels, most ${one.label}`, loading: 'lazy' }));
      const text = make('div');
      text.append(make('p', {}, `${percent(one.error)}%: ${one.place}`), make('code', {}, one.command));
      box.append(text);
      return box;
    }));
    if (!shown.length) fill(byId('worst'), make('p', { class: 'note' }, all.length ? 'None of its ten worst cases is among what is chosen above.' : 'It is wrong nowhere.'));
  }

  function draw() {
    ranking();
    plot('texels', TEXELS, 'texels');
    plot('frames', FRAME, 'ms');
    heat();
    worst();
    pairs();
  }

  for (const [name, values] of [['scene', data.scenes], ['map', data.maps], ['size', data.sizes]]) {
    const select = byId(name);
    select.append(make('option', { value: -1 }, 'all'), ...values.map((value, i) => make('option', { value: i }, value)));
    select.addEventListener('change', () => { choice[name] = Number(select.value); draw(); });
  }
  byId('method').append(...subsetAt(-1, -1, -1).methods.map((row) => make('option', { value: row[METHOD] }, data.methods[row[METHOD]])));
  byId('method').addEventListener('change', worst);
  byId('measure').textContent = { bias_error: 'The bias error (acne + leak)', all_wrong: 'All wrong pixels', rmse: 'The RMSE through the filter' }[data.error];
  byId('filters').hidden = byId('scripted').hidden = false;
  draw();
})();
