// Sliders over a study's emulator (app/study/sliders.cpp): the Gaussian process where they stand, as solvers/kriging has
// it, and the line of each answer along the parameter that was moved last.
'use strict';
{
  const dot = (a, b) => a.reduce((sum, v, i) => sum + v * b[i], 0);
  const matern = (a, b) => {
    let square = 0;
    for (let i = 0; i < a.length; ++i) square += (a[i] - b[i]) ** 2;
    const d = Math.sqrt(5 * square);
    return (1 + d + d * d / 3) * Math.exp(-d);
  };
  /// The lower Cholesky factor of a symmetric matrix, and L^-1 b.
  const factor = (matrix) => {
    const l = [];
    matrix.forEach((row, i) => {
      l.push([]);
      for (let j = 0; j <= i; ++j) {
        const left = row[j] - dot(l[i].slice(0, j), l[j]);
        l[i].push(i === j ? Math.sqrt(left) : left / l[j][j]);
      }
    });
    return l;
  };
  const forward = (l, b) => {
    const x = [];
    l.forEach((row, i) => x.push((b[i] - dot(x, row)) / row[i]));
    return x;
  };

  /// An answer's process: its mean at parameters so scaled, and the standard deviation of its error.
  const process = (answer) => {
    const { points, length, plane, weight, nugget } = answer;
    const trend = (x) => (plane.length > 1 ? [1, ...x] : [1]);
    const l = factor(points.map((p, i) => points.slice(0, i + 1).map((q, j) => (i === j ? 1 + nugget : matern(p, q)))));
    const columns = plane.map((_, c) => forward(l, points.map((p) => trend(p.map((v, i) => v * length[i]))[c])));
    const normal = factor(columns.map((a) => columns.map((b) => dot(a, b))));
    const covariances = (x) => points.map((p) => matern(p, x.map((v, i) => v / length[i])));
    return {
      mean: (x) => dot(plane, trend(x)) + dot(weight, covariances(x)),
      error: (x) => {
        const k = forward(l, covariances(x)), open = trend(x).map((f, c) => f - dot(columns[c], k));
        const of_plane = forward(normal, open);
        const share = 1 - dot(k, k) + dot(of_plane, of_plane);
        return Math.sqrt((Math.max(share, 0) + nugget) * answer.process);
      },
    };
  };

  // As many digits as two of the error leave.
  const digits = (error) => Math.min(9, Math.max(0, 1 - Math.floor(Math.log10(error))));
  const svg = (name, attributes) => {
    const element = document.createElementNS('http://www.w3.org/2000/svg', name);
    for (const key in attributes) element.setAttribute(key, attributes[key]);
    return element;
  };

  const start = (figure, study) => {
    const { parameters, answers } = study, processes = answers.map(process);
    const at = parameters.map((p) => (p.low + p.high) / 2);
    let moved = 0;
    const scaled = (values) => values.map((v, i) => (v - parameters[i].centre) / parameters[i].half);
    const drawn = [];

    const show = () => {
      parameters.forEach((p, i) => { p.said.textContent = `${at[i].toPrecision(4)} ${p.unit}`; });
      figure.querySelector('[data-part=along]').textContent = `along ${parameters[moved].label}`;
      answers.forEach((answer, a) => {
        const { mean, error } = processes[a], value = mean(scaled(at));
        const off = Math.max(answer.error, error(scaled(at))), n = digits(off);
        drawn[a].said.textContent = `${value.toFixed(n)} \u00b1 ${off.toFixed(n)} ${answer.unit}`;
        const p = parameters[moved], line = [];
        for (let k = 0; k <= 40; ++k) {
          const values = at.slice();
          values[moved] = p.low + (p.high - p.low) * k / 40;
          line.push(mean(scaled(values)));
        }
        // The range of the study's own points, so that a flat line is one.
        const low = Math.min(answer.low, ...line, value), high = Math.max(answer.high, ...line, value);
        const y = (v) => 56 - 52 * (v - low) / (high - low);
        drawn[a].line.setAttribute('points', line.map((v, k) => `${4 + 4.8 * k},${y(v).toFixed(1)}`).join(' '));
        drawn[a].dot.setAttribute('cx', 4 + 192 * (at[moved] - p.low) / (p.high - p.low));
        drawn[a].dot.setAttribute('cy', y(value));
      });
    };

    parameters.forEach((p, i) => {
      const label = document.createElement('label'), slider = document.createElement('input');
      p.said = document.createElement('output');
      Object.assign(slider, { type: 'range', min: 0, max: 200, step: 1, value: 100 });
      slider.oninput = () => { at[i] = p.low + (p.high - p.low) * slider.value / 200; moved = i; show(); };
      label.append(p.label, slider, p.said);
      figure.querySelector('[data-part=parameters]').append(label);
    });
    for (const answer of answers) {
      const row = figure.querySelector('table').insertRow(), picture = svg('svg', { viewBox: '0 0 200 60', class: 'spark' });
      const line = svg('polyline', { class: 'line-after' }), dot = svg('circle', { r: 4, class: 'holdout' });
      picture.append(line, dot);
      row.insertCell().textContent = answer.label;
      const said = row.insertCell();
      row.insertCell().append(picture);
      drawn.push({ said, line, dot });
    }
    show();
    figure.hidden = false;
  };

  for (const figure of document.querySelectorAll('figure[data-sliders]')) {
    try {
      start(figure, JSON.parse(document.getElementById(figure.dataset.sliders).textContent));
    } catch (error) {
      figure.hidden = true;  // the tables and pictures stand beside
      console.error(error);
    }
  }
}
