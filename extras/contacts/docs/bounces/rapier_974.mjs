// The test of Rapier's issue 974 in the packages for JavaScript: node rapier_974.mjs r19
const Rapier = (await import(process.argv[2] ?? "@dimforge/rapier3d-compat")).default;
await Rapier.init();

// The part of a drop from 2 m that is recovered, after the issue: both colliders have r.
function recovered(r, step, prediction) {
  const world = new Rapier.World({ x: 0, y: -9.81, z: 0 });
  world.timestep = step;
  if (prediction) world.integrationParameters.normalizedPredictionDistance = prediction;
  const ground = Rapier.ColliderDesc.cuboid(30, 0.1, 30).setRestitution(r);
  world.createCollider(ground, world.createRigidBody(Rapier.RigidBodyDesc.fixed()));
  const ball = world.createRigidBody(Rapier.RigidBodyDesc.dynamic().setTranslation(0, 2.3, 0));
  world.createCollider(Rapier.ColliderDesc.ball(0.2).setDensity(1).setRestitution(r), ball);
  const heights = [];
  for (let time = 0; time < 1.3; time += world.timestep) {
    world.step();
    heights.push(ball.translation().y - 0.3);
  }
  const rising = heights.findIndex((height, k) => height > heights[k - 1]);
  return Math.max(...heights.slice(rising)) / 2;
}

// Lines of rapier_974.csv: node rapier_974.mjs r19
const usual = new Rapier.World({ x: 0, y: 0, z: 0 }).integrationParameters;
const default_ = Number(usual.normalizedPredictionDistance.toPrecision(3));
for (const [step, prediction] of [[60, 0], [60, 0.02], [60, 0.1], [1000, 0]]) {
  if (prediction === default_) continue;
  const found = [0.3, 0.5, 0.8, 0.95].map((r) => recovered(r, 1 / step, prediction).toFixed(4));
  const start = ["JavaScript " + Rapier.version(), "1/" + step, prediction || default_];
  console.log([...start, ...found, "`rapier_974.mjs`"].join(","));
}
