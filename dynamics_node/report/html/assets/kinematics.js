// Poses of the bodies and gravity torques of the joints at any position: A_k and G of
// docs/mathematics.md. A test compares both with the library.
// A pose is 12 numbers, the first three rows of the 4x4 matrix, row by row.
const kinematics = (() => {
  'use strict';

  const cross = (a, b) => [
    a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

  function multiply(a, b) {
    const product = new Array(12);
    for (let row = 0; row < 12; row += 4) {
      for (let column = 0; column < 4; column += 1) {
        product[row + column] = a[row] * b[column] + a[row + 1] * b[4 + column]
          + a[row + 2] * b[8 + column] + (column === 3 ? a[row + 3] : 0);
      }
    }
    return product;
  }

  // Rodrigues' formula about a unit vector.
  function turn([x, y, z], angle) {
    const c = Math.cos(angle);
    const s = Math.sin(angle);
    const v = 1 - c;
    return [c + x * x * v, x * y * v - z * s, x * z * v + y * s, 0,
      y * x * v + z * s, c + y * y * v, y * z * v - x * s, 0,
      z * x * v - y * s, z * y * v + x * s, c + z * z * v, 0];
  }

  const slide = ([x, y, z], way) => [1, 0, 0, x * way, 0, 1, 0, y * way, 0, 0, 1, z * way];

  const at = (pose, [x, y, z]) => [
    pose[0] * x + pose[1] * y + pose[2] * z + pose[3],
    pose[4] * x + pose[5] * y + pose[6] * z + pose[7],
    pose[8] * x + pose[9] * y + pose[10] * z + pose[11]];

  const along = (pose, [x, y, z]) => [
    pose[0] * x + pose[1] * y + pose[2] * z,
    pose[4] * x + pose[5] * y + pose[6] * z,
    pose[8] * x + pose[9] * y + pose[10] * z];

  const base = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];

  // The pose of every body in the base frame; a parent comes before its children.
  function poses(robot, q) {
    const bodies = [];
    robot.parent.forEach((parent, k) => {
      const position = robot.multiplier[k] * q[robot.coordinate[k]] + robot.offset[k];
      const motion = (robot.slides[k] ? slide : turn)(robot.axis[k], position);
      const placed = multiply(robot.placement[k].flat(), motion);
      bodies.push(parent < 0 ? placed : multiply(bodies[parent], placed));
    });
    return bodies;
  }

  // G, equation (17) with subtree sums of mass and of mass times position, mimics by (19).
  function gravityTorque(robot, q, bodies = poses(robot, q)) {
    const mass = robot.mass.slice();
    const moment = bodies.map((pose, k) => at(pose, robot.com[k]).map((x) => x * mass[k]));
    const torque = new Array(robot.joints.length).fill(0);
    for (let k = bodies.length - 1; k >= 0; k -= 1) {
      const axis = along(bodies[k], robot.axis[k]);
      const origin = [bodies[k][3], bodies[k][7], bodies[k][11]];
      const lever = moment[k].map((x, i) => x - mass[k] * origin[i]);
      const way = robot.slides[k] ? axis.map((x) => x * mass[k]) : cross(axis, lever);
      torque[robot.coordinate[k]] -= robot.multiplier[k] * dot(robot.gravity, way);
      const parent = robot.parent[k];
      if (parent >= 0) {
        mass[parent] += mass[k];
        moment[parent] = moment[parent].map((x, i) => x + moment[k][i]);
      }
    }
    return torque;
  }

  return { poses, gravityTorque, at, along, base };
})();
