// The blow of a report's page in three dimensions: reads what post/moving_blow.cpp wrote into the page, draws it by vtk.js.
// Bundled into viewer.js by scripts/build-viewer.
import '@kitware/vtk.js/Rendering/OpenGL/Actor.js';
import '@kitware/vtk.js/Rendering/OpenGL/Camera.js';
import '@kitware/vtk.js/Rendering/OpenGL/PolyDataMapper.js';
import '@kitware/vtk.js/Rendering/OpenGL/Renderer.js';
import vtkOpenGLRenderWindow from '@kitware/vtk.js/Rendering/OpenGL/RenderWindow.js';
import vtkActor from '@kitware/vtk.js/Rendering/Core/Actor.js';
import vtkColorTransferFunction from '@kitware/vtk.js/Rendering/Core/ColorTransferFunction.js';
import vtkDataArray from '@kitware/vtk.js/Common/Core/DataArray.js';
import vtkMapper from '@kitware/vtk.js/Rendering/Core/Mapper.js';
import vtkPolyData from '@kitware/vtk.js/Common/DataModel/PolyData.js';
import vtkRenderer from '@kitware/vtk.js/Rendering/Core/Renderer.js';
import vtkRenderWindow from '@kitware/vtk.js/Rendering/Core/RenderWindow.js';
import vtkRenderWindowInteractor from '@kitware/vtk.js/Rendering/Core/RenderWindowInteractor.js';
import vtkTrackball from '@kitware/vtk.js/Interaction/Style/InteractorStyleTrackballCamera.js';

const STOPS = [[255, 255, 217], [199, 233, 180], [65, 182, 196], [34, 94, 168], [8, 29, 88]];  // as post/ball_section.cpp

const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
const words = (text) => new Uint16Array(bytes(text));  // little-endian, as every browser's machine

// Linear combinations of stored points: what a finer mesh of the same quadratic interpolation is made of.
class Mesh {
  constructor(triangles, combinations) {
    this.triangles = triangles;
    this.combinations = combinations;  // of each point: [[stored point, weight], ...]; null: the stored points themselves
  }
  of(values, components, count) {
    if (!this.combinations) return values;
    const out = new Float32Array(this.combinations.length * components);
    this.combinations.forEach((terms, i) => {
      for (const [point, weight] of terms)
        for (let k = 0; k < components; ++k) out[i * components + k] += weight * values[point * components + k];
    });
    return out;
  }
}

const line = (x) => [0.5 * x * (x - 1), 1 - x * x, 0.5 * x * (x + 1)];  // through three points

// A surface of `rows` points from pole to pole times `columns` around, every second one a corner of a quadratic element.
function grid(rows, columns, half) {
  const parts = 4, around = half ? columns / 2 : columns, index = new Map(), combinations = [], triangles = [];
  const at = (i, j) => {  // in parts of two steps
    const key = `${i} ${half ? j : j % (around / 2 * parts)}`;
    if (index.has(key)) return index.get(key);
    const element = (x, last) => Math.min(Math.floor(x / parts), last);
    const a = element(i, (rows - 1) / 2 - 1), b = element(j, around / 2 - 1);
    const x = line(2 * (i - a * parts) / parts - 1), y = line(2 * (j - b * parts) / parts - 1), terms = [];
    for (let k = 0; k < 3; ++k)
      for (let l = 0; l < 3; ++l)
        if (x[k] * y[l] !== 0) terms.push([(2 * a + k) * columns + (2 * b + l) % columns, x[k] * y[l]]);
    index.set(key, combinations.length);
    combinations.push(terms);
    return combinations.length - 1;
  };
  for (let i = 0; i < (rows - 1) / 2 * parts; ++i)
    for (let j = 0; j < around / 2 * parts; ++j)
      triangles.push(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1));
  return new Mesh(triangles, combinations);
}

// Eight-node squares: corners, then the nodes amid the sides.
function squares(elements) {
  const parts = 3, combinations = [], triangles = [];
  for (let e = 0; e < elements.length; e += 8) {
    const first = combinations.length;
    for (let k = 0; k <= parts; ++k)
      for (let l = 0; l <= parts; ++l) {
        const x = 2 * l / parts - 1, y = 2 * k / parts - 1;
        const corner = (a, b) => 0.25 * (1 + a * x) * (1 + b * y) * (a * x + b * y - 1);
        const shape = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1), 0.5 * (1 - x * x) * (1 - y),
          0.5 * (1 + x) * (1 - y * y), 0.5 * (1 - x * x) * (1 + y), 0.5 * (1 - x) * (1 - y * y)];
        combinations.push(shape.map((weight, i) => [elements[e + i], weight]));
        if (k === parts || l === parts) continue;
        const c = first + k * (parts + 1) + l, d = c + parts + 1;
        triangles.push(c, c + 1, d + 1, c, d + 1, d);
      }
  }
  return new Mesh(triangles, combinations);
}

// Around a line of points, a tube; the radius is that of each point.
function tube(points, radii, sides = 16) {
  const n = points.length / 3, out = new Float32Array(n * sides * 3), up = [0.13, 0.9, 0.41];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (a) => { const s = Math.hypot(...a) || 1; return a.map((x) => x / s); };
  for (let i = 0; i < n; ++i) {
    const a = Math.max(0, i - 1), b = Math.min(n - 1, i + 1);
    const along = [0, 1, 2].map((k) => points[3 * b + k] - points[3 * a + k]);
    const u = unit(cross(along, up)), v = unit(cross(along, u));
    for (let j = 0; j < sides; ++j) {
      const c = Math.cos(2 * Math.PI * j / sides) * radii[i], s = Math.sin(2 * Math.PI * j / sides) * radii[i];
      for (let k = 0; k < 3; ++k) out[3 * (i * sides + j) + k] = points[3 * i + k] + c * u[k] + s * v[k];
    }
  }
  return out;
}
function tubeMesh(n, sides = 16) {
  const triangles = [];
  for (let i = 0; i + 1 < n; ++i)
    for (let j = 0; j < sides; ++j) {
      const a = i * sides + j, b = i * sides + (j + 1) % sides;
      triangles.push(a, b, b + sides, a, b + sides, a + sides);
    }
  return new Mesh(triangles, null);
}

function normals(points, triangles) {
  const out = new Float32Array(points.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const ux = points[b] - points[a], uy = points[b + 1] - points[a + 1], uz = points[b + 2] - points[a + 2];
    const vx = points[c] - points[a], vy = points[c + 1] - points[a + 1], vz = points[c + 2] - points[a + 2];
    const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    for (const i of [a, b, c])
      for (let k = 0; k < 3; ++k) out[i + k] += n[k];
  }
  for (let i = 0; i < out.length; i += 3) {
    const s = Math.hypot(out[i], out[i + 1], out[i + 2]) || 1;
    for (let k = 0; k < 3; ++k) out[i + k] /= s;
  }
  return out;
}

class Body {
  constructor(data, mesh, look) {
    this.data = data;
    this.mesh = mesh;
    this.values = words(data.place);
    this.fields = Object.fromEntries(Object.entries(data.fields || {}).map(([name, f]) => [name, words(f.values)]));
    this.poly = vtkPolyData.newInstance();
    const cells = new Uint32Array(mesh.triangles.length / 3 * 4);
    for (let i = 0, j = 0; i < mesh.triangles.length; i += 3, j += 4)
      cells.set([3, mesh.triangles[i], mesh.triangles[i + 1], mesh.triangles[i + 2]], j);
    this.poly.getPolys().setData(cells);
    this.mapper = vtkMapper.newInstance({interpolateScalarsBeforeMapping: true});
    this.mapper.setInputData(this.poly);
    this.actor = vtkActor.newInstance();
    this.actor.setMapper(this.mapper);
    const p = this.actor.getProperty();
    p.setColor(...look.colour);
    p.setOpacity(look.opacity ?? 1);
    p.setAmbient(look.ambient ?? 0.25);
    p.setDiffuse(look.diffuse ?? 0.75);
    p.setSpecular(look.specular ?? 0);
    p.setSpecularPower(30);
  }
  stored(frame) {
    const n = 3 * this.data.points, from = frame * n, out = new Float32Array(n);
    for (let i = 0; i < n; ++i) out[i] = this.data.low[i % 3] + this.data.step * this.values[from + i];
    return out;
  }
  place(points) {
    this.poly.getPoints().setData(points, 3);
    this.poly.getPointData().setNormals(
      vtkDataArray.newInstance({name: 'normals', numberOfComponents: 3, values: normals(points, this.mesh.triangles)}));
  }
  show(frame, field) {
    this.place(this.mesh.of(this.stored(frame), 3));
    const values = this.fields[field];
    this.mapper.setScalarVisibility(Boolean(values));
    if (values) {
      const n = this.data.points, most = this.data.fields[field].most, now = new Float32Array(n);
      for (let i = 0; i < n; ++i) now[i] = most * values[frame * n + i] / 65535;
      this.poly.getPointData().setScalars(
        vtkDataArray.newInstance({name: field, values: this.mesh.of(now, 1)}));
    }
    this.poly.modified();
  }
}

function start(figure, blow) {
  const by = (name) => figure.querySelector(`[data-part=${name}]`);
  const view = by('view'), slider = by('time'), said = by('said'), play = by('play'), colour = by('colour'),
    cut = by('cut'), legend = by('legend');
  const probe = document.createElement('canvas').getContext('webgl2');
  if (!probe) return;  // the still picture stands beside
  probe.getExtension('WEBGL_lose_context')?.loseContext();

  const found = Object.fromEntries(blow.bodies.map((b) => [b.name, b]));
  const ballLook = {colour: [0.93, 0.93, 0.9], specular: 0.1, ambient: 0.35, diffuse: 0.7};
  const bodies = {
    whole: new Body(found.ball, grid(...found.ball.grid, false), ballLook),
    half: new Body(found.ball, grid(...found.ball.grid, true), ballLook),
    section: new Body(found.section, squares(words(found.section.elements)), {...ballLook, ambient: 0.9, diffuse: 0.1, specular: 0}),
  };
  for (const [name, opacity] of [['face', 0.45], ['head', 0.16]])
    if (found[name])
      bodies[name] = new Body(found[name], new Mesh(Array.from(words(found[name].triangles)), null),
        {colour: [0.42, 0.46, 0.52], opacity, specular: 0.2});
  if (found.shaft) {
    const shaft = bodies.shaft = new Body(found.shaft, tubeMesh(found.shaft.points), {colour: [0.3, 0.32, 0.36], specular: 0.3});
    shaft.show = function (frame) { this.place(tube(this.stored(frame), found.shaft.radius)); this.poly.modified(); };
    // The hands: a sleeve over the grip's first 0.18 m.
    let count = 2;
    const first = shaft.stored(0), far = (i) => Math.hypot(...[0, 1, 2].map((k) => first[3 * i + k] - first[k]));
    while (count < found.shaft.points && far(count - 1) < 0.18) ++count;
    const hands = bodies.hands = new Body(found.shaft, tubeMesh(count), {colour: [0.83, 0.62, 0.45]});
    hands.show = function (frame) {
      this.place(tube(this.stored(frame).slice(0, 3 * count), Array(count).fill(0.024)));
      this.poly.modified();
    };
  }

  const renderer = vtkRenderer.newInstance(), window_ = vtkRenderWindow.newInstance(), gl = vtkOpenGLRenderWindow.newInstance();
  window_.addRenderer(renderer);
  window_.addView(gl);
  gl.setContainer(view);
  // The wheel scrolls the page; with ctrl it zooms.
  view.addEventListener('wheel', (e) => { if (!e.ctrlKey) e.stopImmediatePropagation(); }, true);
  const interactor = vtkRenderWindowInteractor.newInstance();
  interactor.setView(gl);
  interactor.initialize();
  interactor.bindEvents(view);
  interactor.setInteractorStyle(vtkTrackball.newInstance());
  for (const body of Object.values(bodies)) renderer.addActor(body.actor);

  const table = vtkColorTransferFunction.newInstance();
  legend.querySelector('i').style.background =
    `linear-gradient(90deg,${STOPS.map((c) => `rgb(${c.join()})`).join()})`;

  const camera = renderer.getActiveCamera();
  camera.setParallelProjection(true);
  const followed = blow.centre;  // of the ball, by frame
  let frame = blow.start, timer = 0, last = frame;

  function draw() {
    const field = colour.value, most = found.ball.fields[field].most, title = found.ball.fields[field].title;
    table.removeAllPoints();
    STOPS.forEach((c, i) => table.addRGBPoint(most * i / (STOPS.length - 1), ...c.map((x) => x / 255)));
    legend.querySelector('b').textContent = title;
    legend.querySelectorAll('span')[1].textContent = most.toPrecision(3);
    bodies.whole.actor.setVisibility(!cut.checked);
    bodies.half.actor.setVisibility(cut.checked);
    bodies.section.actor.setVisibility(cut.checked);
    for (const body of Object.values(bodies)) {
      if (!body.actor.getVisibility()) continue;
      body.mapper.setLookupTable(table);
      body.mapper.setScalarRange(0, most);
      body.show(frame, field);
    }
    // The camera goes with the ball.
    const by = [0, 1, 2].map((k) => followed[frame][k] - followed[last][k]);
    last = frame;
    camera.setFocalPoint(...camera.getFocalPoint().map((x, k) => x + by[k]));
    camera.setPosition(...camera.getPosition().map((x, k) => x + by[k]));
    renderer.resetCameraClippingRange();
    slider.value = frame;
    said.textContent = `${blow.time_ms[frame].toFixed(3)} ms, ${blow.force_kN[frame].toFixed(2)} kN`;
    slider.setAttribute('aria-valuetext', said.textContent);
    window_.render();
  }

  function look(from, up, scale, at) {
    const focus = at || followed[frame];
    camera.setFocalPoint(...focus);
    camera.setPosition(...focus.map((x, k) => x + 2 * from[k]));
    camera.setViewUp(...up);
    camera.setParallelScale(scale);
  }
  // The face's own axes: what is seen through it is seen from behind it.
  const radius = blow.radius, back = blow.face_axes[0].map((x) => -x);
  const views = {
    side: () => { cut.checked = true; colour.value = 'stress'; look([-0.25, -1, 0.25], [0, 0, 1], 1.6 * radius); },
    face: () => { cut.checked = false; colour.value = 'pressure'; look(back, blow.face_axes[2], 1.35 * radius); },
    club: () => {
      const line = bodies.shaft.stored(frame), end = line.length - 3;
      look([-0.5, 1.4, 0.25], [0, 0, 1], 0.62, [0, 1, 2].map((k) => 0.5 * (line[k] + line[end + k])));
    },
  };
  for (const button of figure.querySelectorAll('button[data-view]')) {
    if (button.dataset.view === 'club' && !bodies.shaft) button.remove();
    else button.onclick = () => { views[button.dataset.view](); draw(); };
  }

  function stop() {
    clearInterval(timer);
    timer = 0;
    play.textContent = 'Play';
  }
  play.onclick = () => {
    if (timer) return stop();
    play.textContent = 'Pause';
    timer = setInterval(() => { frame = (frame + 1) % blow.time_ms.length; draw(); }, 80);
  };
  slider.max = blow.time_ms.length - 1;
  slider.oninput = () => { stop(); frame = Number(slider.value); draw(); };
  colour.onchange = cut.onchange = draw;

  const page = () => {
    const c = getComputedStyle(document.body).backgroundColor.match(/[\d.]+/g).slice(0, 3).map((x) => x / 255);
    renderer.setBackground(...c);
  };
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { page(); draw(); });
  const size = () => {
    const box = view.getBoundingClientRect(), by = window.devicePixelRatio || 1;
    gl.setSize(Math.floor(box.width * by), Math.floor(box.height * by));
    draw();
  };
  figure.hidden = false;
  page();
  views.side();
  size();
  new ResizeObserver(size).observe(view);
}

for (const figure of document.querySelectorAll('figure[data-blow]')) {
  const text = document.getElementById(figure.dataset.blow).textContent;
  try {
    start(figure, JSON.parse(text));
  } catch (error) {
    figure.hidden = true;  // the still picture stands beside
    console.error(error);
  }
}
