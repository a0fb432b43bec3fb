// The test of Rapier's issue 974 in the packages for JavaScript: node rapier_974.mjs r19
const Rapier = (await import(process.argv[2] ?? "@dimforge/rapier3d-compat")).default;
await Rapier.init();

// The part of a drop from 2 m that is recovered, after the issue: both colliders have r.
function recovered(r, step, prediction) {
  const world = new Rapier.World({ x: 0, y: -9.81, z: 0 });
  if (step) world.timestep = step;
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

const row = (...settings) => [0.3, 0.5, 0.8, 0.95].map((r) => recovered(r, ...settings).toFixed(4));
console.log(Rapier.version(), "default", ...row());
console.log(Rapier.version(), "at 1/1000 s", ...row(1e-3));
console.log(Rapier.version(), "prediction 0.1", ...row(0, 0.1));
