// The arm in 3D with a slider and the gravity torque for every joint.
const arm = (() => {
  'use strict';

  // A ball of triangles: an octahedron, each side cut into four, once or twice.
  function makeBall(cuts) {
    let corners = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
    let sides = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4],
      [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    for (let cut = 0; cut < cuts; cut += 1) {
      const middles = new Map();
      const middle = (a, b) => {
        const name = a < b ? `${a} ${b}` : `${b} ${a}`;
        if (!middles.has(name)) {
          const sum = corners[a].map((x, i) => x + corners[b][i]);
          const length = Math.hypot(...sum);
          middles.set(name, corners.length);
          corners = [...corners, sum.map((x) => x / length)];
        }
        return middles.get(name);
      };
      sides = sides.flatMap(([a, b, c]) => {
        const [d, e, f] = [middle(a, b), middle(b, c), middle(c, a)];
        return [[a, d, f], [d, b, e], [f, e, c], [d, e, f]];
      });
    }
    return { corners, sides };
  }

  function makeMesh(ball, name, look) {
    return { type: 'mesh3d', name, hoverinfo: 'skip', x: [], y: [], z: [],
      i: [], j: [], k: [], ball, flatshading: false,
      lighting: { ambient: 0.62, diffuse: 0.6, specular: 0.15, roughness: 0.7, fresnel: 0.1 },
      lightposition: { x: 1000, y: -1500, z: 3000 }, ...look };
  }

  // One mesh for all bodies: a ball stretched by the three columns of each matrix.
  function fill(mesh, shapes) {
    const { corners, sides } = mesh.ball;
    ['x', 'y', 'z', 'i', 'j', 'k'].forEach((key) => { mesh[key] = []; });
    shapes.forEach(({ center, columns }) => {
      const first = mesh.x.length;
      corners.forEach((corner) => {
        ['x', 'y', 'z'].forEach((key, row) => {
          mesh[key].push(center[row] + columns[row][0] * corner[0]
            + columns[row][1] * corner[1] + columns[row][2] * corner[2]);
        });
      });
      sides.forEach((side) => {
        ['i', 'j', 'k'].forEach((key, corner) => mesh[key].push(first + side[corner]));
      });
    });
  }

  function lines(pairs) {
    const line = { x: [], y: [], z: [] };
    pairs.forEach((pair) => {
      pair.forEach((point) => ['x', 'y', 'z'].forEach((key, i) => line[key].push(point[i])));
      ['x', 'y', 'z'].forEach((key) => line[key].push(null));
    });
    return line;
  }

  const points = (list) => ({
    x: list.map((p) => p[0]), y: list.map((p) => p[1]), z: list.map((p) => p[2]) });

  function digits(value, count = 3) {
    if (value !== 0 && (Math.abs(value) < 1e-3 || Math.abs(value) >= 1e5)) {
      return value.toExponential(count - 1).replace('-', '−');
    }
    return String(Number(value.toPrecision(count))).replace('-', '−');
  }

  const has3d = () => {
    try {
      const canvas = document.createElement('canvas');
      return Boolean(canvas.getContext('webgl') || canvas.getContext('webgl2'));
    } catch {
      return false;
    }
  };

  // All shapes at a position of the joints, in meters.
  function geometry(robot, q, axisLength) {
    const bodies = kinematics.poses(robot, q);
    const pose = (body) => (body < 0 ? kinematics.base : bodies[body]);
    const center = (k) => kinematics.at(bodies[k], robot.com[k]);
    return {
      bodies,
      sticks: robot.sticks.map((pair) => pair.map(([body, p]) => kinematics.at(pose(body), p))),
      joints: bodies.map((own) => [own[3], own[7], own[11]]),
      axes: bodies.map((own, k) => [-axisLength, axisLength].map((way) => (
        kinematics.at(own, robot.axis[k].map((x) => x * way))))),
      // Longer than the ball around the joint, if there is one.
      longAxes: bodies.map((own, k) => [-1, 1].map((way) => (kinematics.at(own,
        robot.axis[k].map((x) => x * way * (2 * axisLength + 1.2 * robot.ball[k])))))),
      centers: bodies.map((_, k) => center(k)),
      balls: bodies.map((_, k) => ({ center: center(k),
        columns: [[robot.ball[k], 0, 0], [0, robot.ball[k], 0], [0, 0, robot.ball[k]]] })),
      ellipsoids: bodies.map((own, k) => ({ center: center(k),
        columns: [0, 4, 8].map((row) => [0, 1, 2].map((column) => (
          own[row] * robot.ellipsoid[k][0][column]
          + own[row + 1] * robot.ellipsoid[k][1][column]
          + own[row + 2] * robot.ellipsoid[k][2][column]))) })),
    };
  }

  // Points that must fit into the picture: the sticks and the corners around balls and shells.
  function outline(shape) {
    const corners = [...shape.balls, ...shape.ellipsoids].flatMap(({ center, columns }) => (
      [-1, 1].map((way) => center.map((x, i) => x + way * Math.hypot(...columns[i])))));
    return [...shape.sticks.flat(), ...corners];
  }

  function grow(seen, list) {
    list.forEach((point) => point.forEach((x, i) => {
      seen[i][0] = Math.min(seen[i][0], x);
      seen[i][1] = Math.max(seen[i][1], x);
    }));
  }

  function start({ robot, poses, labels }) {
    const state = { q: robot.neutral.slice(), joint: null,
      shown: { masses: true, ellipsoids: true, axes: true } };
    const caption = document.getElementById('arm-caption');
    const seen = [[0, 0], [0, 0], [0, 0]];
    poses.forEach(({ q }) => grow(seen, outline(geometry(robot, q, 0))));
    const size = () => Math.max(...seen.map(([low, high]) => high - low), 1e-6);
    const axisLength = 0.035 * size();
    const cuts = robot.body.length > 60 ? 1 : 2;
    const look = {
      sticks: { type: 'scatter3d', mode: 'lines', name: 'links', hoverinfo: 'skip',
        line: { width: 7, color: { css: 'muted' } } },
      axes: { type: 'scatter3d', mode: 'lines', name: 'joint axes', hoverinfo: 'skip',
        line: { width: 9, color: { css: 'accent' } } },
      chosen: { type: 'scatter3d', mode: 'lines', name: 'chosen joint', hoverinfo: 'skip',
        line: { width: 14, color: { css: 'problem' } } },
      joints: { type: 'scatter3d', mode: 'markers', name: 'joints', hoverinfo: 'text',
        text: labels.joints, marker: { size: 4.5, color: { css: 'accent' } } },
      balls: makeMesh(makeBall(cuts), 'masses', { color: { css: 'mass' }, opacity: 1 }),
      ellipsoids: makeMesh(makeBall(cuts), 'inertia', { color: { css: 'shape' },
        opacity: 0.3 }),
      centers: { type: 'scatter3d', mode: 'markers', name: 'centers of mass',
        hoverinfo: 'text', text: labels.bodies,
        marker: { size: 3, color: { css: 'mass' } } },
      gravity: { type: 'scatter3d', mode: 'lines', name: 'gravity', hoverinfo: 'skip',
        line: { width: 5, color: { css: 'faint' } } },
      arrow: { type: 'cone', name: 'gravity', sizemode: 'absolute', anchor: 'cm',
        showscale: false, colorscale: [[0, { css: 'faint' }], [1, { css: 'faint' }]],
        hoverinfo: 'text', text: `gravity ${digits(Math.hypot(...robot.gravity))} m/s²` },
    };

    // The visible box: everything drawn so far, and no side much shorter than the others.
    function box() {
      const room = 0.05 * size();
      return seen.map(([low, high]) => {
        const half = Math.max((high - low) / 2 + room, 0.35 * size());
        return [(low + high) / 2 - half, (low + high) / 2 + half];
      });
    }

    // The longest side is 1, so that robots of any size fill the view.
    function aspect(ends) {
      const sides = ends.map(([low, high]) => high - low);
      const [x, y, z] = sides.map((side) => side / Math.max(...sides));
      return { x, y, z };
    }

    // An arrow at the edge of the picture, beside the arm.
    function gravityArrow(ends) {
      const strength = Math.hypot(...robot.gravity);
      const way = robot.gravity.map((x) => (strength > 0 ? 0.16 * size() * x / strength : 0));
      const from = [0.9 * ends[0][0] + 0.1 * ends[0][1], 0.1 * ends[1][0] + 0.9 * ends[1][1],
        0.1 * ends[2][0] + 0.9 * ends[2][1]];
      const to = from.map((x, i) => x + way[i]);
      return [
        { ...look.gravity, ...lines([[from, to]]) },
        { ...look.arrow, x: [to[0]], y: [to[1]], z: [to[2]], u: [way[0]], v: [way[1]],
          w: [way[2]], sizeref: 0.05 * size(), visible: strength > 0 }];
    }

    function figure() {
      const shape = geometry(robot, state.q, axisLength);
      grow(seen, outline(shape));
      const ends = box();
      fill(look.balls, shape.balls);
      fill(look.ellipsoids, shape.ellipsoids);
      const chosen = shape.longAxes.filter((_, k) => robot.coordinate[k] === state.joint);
      const traces = [
        { ...look.sticks, ...lines(shape.sticks) },
        { ...look.axes, ...lines(shape.axes), visible: state.shown.axes },
        { ...look.chosen, ...lines(chosen) },
        { ...look.joints, ...points(shape.joints) },
        { ...look.balls, visible: state.shown.masses },
        { ...look.ellipsoids, visible: state.shown.ellipsoids },
        { ...look.centers, ...points(shape.centers), visible: state.shown.masses },
        ...gravityArrow(ends)];
      traces.forEach((trace) => delete trace.ball);
      const side = (i) => ({ title: { text: '' }, ticksuffix: ' m',
        range: ends[i], color: { css: 'muted' },
        gridcolor: { css: 'line' }, zerolinecolor: { css: 'line' }, showbackground: false,
        tickfont: { size: 10 }, nticks: 5, showspikes: false });
      return { data: traces, layout: {
        paper_bgcolor: 'rgba(0,0,0,0)', margin: { l: 0, r: 0, t: 0, b: 0 }, showlegend: false,
        font: { color: { css: 'ink' }, family: 'system-ui, -apple-system, Segoe UI, Arial' },
        modebar: { bgcolor: 'rgba(0,0,0,0)', color: { css: 'faint' },
          activecolor: { css: 'accent' } },
        hoverlabel: { bgcolor: { css: 'raised' }, bordercolor: { css: 'line' },
          font: { color: { css: 'ink' } }, align: 'left', namelength: -1 },
        scene: { xaxis: side(0), yaxis: side(1), zaxis: side(2),
          aspectmode: 'manual', aspectratio: aspect(ends), uirevision: 'kept',
          dragmode: 'turntable',
          camera: { eye: { x: 0.95, y: -1.02, z: 0.46 }, center: { x: 0, y: 0, z: -0.06 }, projection: { type: 'perspective' } } },
        uirevision: 'kept' } };
    }

    const isThere = has3d();
    if (!isThere) {
      const sorry = document.createElement('p');
      sorry.className = 'sorry';
      sorry.textContent = 'The 3D view needs WebGL, which this browser does not offer. '
        + 'The sliders and the torques beside it work all the same.';
      document.getElementById('plot-arm').replaceChildren(sorry);
    }
    let waiting = false;
    const draw = () => {
      if (!isThere || waiting) return;
      waiting = true;
      requestAnimationFrame(() => {
        waiting = false;
        plots.draw('plot-arm', figure(), 0);
      });
    };

    const rows = robot.joints.map((name, place) => makeRow(robot, name, place, {
      moved: (value) => {
        state.q[place] = value;
        caption.textContent = 'A pose of your own. These are its gravity torques.';
        pressed(null);
        update();
      },
      chosen: () => plots.choose(place, 'arm'),
    }));
    document.getElementById('arm-rows').append(...rows.map((row) => row.element));

    function update() {
      const torque = kinematics.gravityTorque(robot, state.q);
      rows.forEach((row, place) => row.show(state.q[place], torque[place],
        place === state.joint));
      draw();
    }

    const buttons = [];
    const pressed = (pose) => buttons.forEach(([button, own]) => {
      button.setAttribute('aria-pressed', String(own === pose));
    });

    function take(pose) {
      state.q = pose.q.slice();
      state.joint = pose.joint;
      caption.textContent = pose.caption;
      pressed(pose);
      update();
    }

    const chips = document.getElementById('arm-poses');
    poses.filter((pose) => pose.joint === null).forEach((pose) => {
      const button = document.createElement('button');
      button.type = 'button';
      button.className = 'chip';
      button.textContent = pose.label;
      button.addEventListener('click', () => take(pose));
      buttons.push([button, pose]);
      chips.append(button);
    });
    document.querySelectorAll('#arm-shown input').forEach((box) => {
      box.addEventListener('change', () => {
        state.shown[box.value] = box.checked;
        draw();
      });
    });
    document.addEventListener('joint', ({ detail }) => {
      take(poses.find((pose) => pose.joint === detail.place));
      if (detail.from !== 'arm') rows[detail.place].reveal();
    });
    document.addEventListener('recolor', draw);
  }

  // A joint: its name (a button to its worst pose), its torque, its slider.
  function makeRow(robot, name, place, { moved, chosen }) {
    const make = (tag, parent, classes = '') => {
      const element = document.createElement(tag);
      if (classes) element.className = classes;
      parent.append(element);
      return element;
    };
    const element = document.createElement('div');
    element.className = 'row';
    const button = make('button', element);
    button.type = 'button';
    button.title = 'to the worst pose of this joint';
    make('span', button, 'name').textContent = name;
    const torque = make('span', element, 'torque');
    const slide = make('label', element, 'slide');
    const input = make('input', slide);
    input.type = 'range';
    input.setAttribute('aria-label', `position of ${name}`);
    // The value is set after min and max, because a slider rounds it to steps from min.
    const [low, high] = [robot.lower[place], robot.upper[place]];
    Object.assign(input, { min: low, max: high, step: 'any' });
    const position = make('span', slide);
    const bar = make('i', make('span', element, 'meter'));
    const limit = robot.limit[place];
    // A millionth of the robot's weight at 1 m is shown as 0: rounded angles in the URDF cause it.
    const rounding = 1e-6 * Math.hypot(...robot.gravity)
      * robot.mass.reduce((sum, mass) => sum + mass, 0);
    const unit = robot.prismatic[place] ? 'N' : 'N m';
    input.addEventListener('input', () => moved(Number(input.value)));
    button.addEventListener('click', chosen);
    const show = (q, effort, isChosen) => {
      input.value = q;
      const degrees = (q * 180 / Math.PI).toFixed(1).replace(/^-0\.0$/, '0.0');
      position.textContent = robot.prismatic[place] ? `${digits(q)} m`
        : `${Math.abs(degrees) < 1e5 ? degrees.replace('-', '−') : digits(Number(degrees))}°`;
      const share = limit > 0 ? Math.abs(effort) / limit : null;
      torque.replaceChildren();
      make('b', torque).textContent = digits(Math.abs(effort) < rounding ? 0 : effort);
      torque.append(` ${unit}${share === null ? '' : `, ${(100 * share).toFixed(0)} %`}`);
      bar.style.width = `${share === null ? 0 : 100 * Math.min(share, 1)}%`;
      bar.className = share > 1 ? 'bad' : share > 0.8 ? 'doubt' : '';
      element.classList.toggle('chosen', isChosen);
    };
    const reveal = () => {
      const list = element.parentElement;
      list.scrollTop = element.offsetTop - list.offsetTop - list.clientHeight / 3;
    };
    return { element, show, reveal };
  }

  return { start };
})();
