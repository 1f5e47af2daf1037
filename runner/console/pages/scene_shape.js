// The shape of a scene, apart from how it is drawn. Lengths in m; z is up.

const headroomShare = 0.25;

function boundsOf(points) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const point of points) {
    for (let axis = 0; axis < 3; axis += 1) {
      low[axis] = Math.min(low[axis], point[axis]);
      high[axis] = Math.max(high[axis], point[axis]);
    }
  }
  return { low, high };
}

function inThrees(numbers) {
  return Array.from({ length: numbers.length / 3 }, (_, index) => numbers.slice(3 * index, 3 * index + 3));
}

// The height where the vertical through (x, y) meets the triangle; null if it passes beside it.
function heightOnTriangle([a, b, c], x, y) {
  const area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
  if (area === 0) return null;
  const v = ((x - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (y - a[1])) / area;
  const w = ((b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1])) / area;
  return v < 0 || w < 0 || v + w > 1 ? null : a[2] + v * (b[2] - a[2]) + w * (c[2] - a[2]);
}

function heightOnSurface(triangles, x, y) {
  let highest = null;
  for (const triangle of triangles) {
    const height = heightOnTriangle(triangle, x, y);
    if (height !== null && (highest === null || height > highest)) highest = height;
  }
  return highest;
}

function boxShape({ size_m: [width, depth, thickness] }) {
  const [x, y] = [width / 2, depth / 2];
  return {
    low: [-x, -y, -thickness],
    high: [x, y, 0],
    heightAt: (px, py) => (Math.abs(px) <= x && Math.abs(py) <= y ? 0 : null),
  };
}

function surfaceShape({ points_m: coordinates, triangles: indices }) {
  const points = inThrees(coordinates);
  const triangles = inThrees(indices).map((corners) => corners.map((index) => points[index]));
  return { ...boundsOf(points), triangles, heightAt: (x, y) => heightOnSurface(triangles, x, y) };
}

// Middle and size of what is at least so large, inside of the shape.
function widened(low, high, least, [from, to]) {
  const size = Math.max(high - low, least);
  return [Math.min(Math.max((low + high) / 2, from + size / 2), to - size / 2), size];
}

// Where a fixation is seen from above: a disc (centre and radius) or a rectangle (centre, width and depth).
function fixationMark({ kind, at_m: at, radius_m: radius, low_m: low, high_m: high }, smallest, shape) {
  if (kind !== "box") return { x: at[0], y: at[1], radius: Math.max(radius ?? 0, smallest) };
  const [x, width] = widened(low[0], high[0], 2 * smallest, [shape.low[0], shape.high[0]]);
  const [y, depth] = widened(low[1], high[1], 2 * smallest, [shape.low[1], shape.high[1]]);
  return { x, y, width, depth };
}

// {low, high, heightAt(x, y), extent, headroom, triangles?, points: [[x, y, z]…], fixations: [{x, y, z, radius} or {x, y, z, width, depth}…]}
export function shapeOf(scene) {
  const shape = scene.kind === "surface" ? surfaceShape(scene) : boxShape(scene);
  const extent = Math.max(shape.high[0] - shape.low[0], shape.high[1] - shape.low[1]);
  const heightOr = (x, y) => shape.heightAt(x, y) ?? shape.high[2];
  return {
    ...shape,
    extent,
    headroom: headroomShare * extent,
    points: (scene.tapping_points_m ?? []).map(([x, y, z]) => [x, y, z ?? heightOr(x, y)]),
    fixations: (scene.fixations ?? [])
      .map((fixation) => fixationMark(fixation, 0.012 * extent, shape))
      .map((mark) => ({ ...mark, z: heightOr(mark.x, mark.y) })),
  };
}
