// The bounce of engines that have a package for JavaScript and no wheel: node javascript.mjs
// npm install jolt-physics@1.1.0 physx-js-webidl@2.7.3 box2d3-wasm@5.2.0
// It prints the lines of javascript.csv: the mean r of balls that meet the ground at eight instants
// within a step, the least and the greatest.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
const G = 9.81;
const RADIUS = 0.1;
const place = createRequire(import.meta.url);

async function jolt() {
  const Jolt = await (await import("jolt-physics")).default();
  return (r, step, drop, steps) => {
    const settings = new Jolt.JoltSettings();
    const objects = new Jolt.ObjectLayerPairFilterTable(2);
    objects.EnableCollision(0, 1);
    const layers = new Jolt.BroadPhaseLayerInterfaceTable(2, 2);
    for (const k of [0, 1]) layers.MapObjectToBroadPhaseLayer(k, new Jolt.BroadPhaseLayer(k));
    settings.mObjectLayerPairFilter = objects;
    settings.mBroadPhaseLayerInterface = layers;
    settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(
      layers, 2, objects, 2,
    );
    const engine = new Jolt.JoltInterface(settings);
    const bodies = engine.GetPhysicsSystem().GetBodyInterface();
    engine.GetPhysicsSystem().SetGravity(new Jolt.Vec3(0, -G, 0));
    const put = (shape, y, motion, layer) => {
      const still = new Jolt.Quat(0, 0, 0, 1);
      const made = new Jolt.BodyCreationSettings(
        shape, new Jolt.RVec3(0, y, 0), still, motion, layer,
      );
      made.mRestitution = r;
      made.mLinearDamping = 0;
      const body = bodies.CreateBody(made);
      bodies.AddBody(body.GetID(), Jolt.EActivation_Activate);
      return body;
    };
    put(new Jolt.BoxShape(new Jolt.Vec3(9, 1, 9)), -1, Jolt.EMotionType_Static, 0);
    const ball = put(new Jolt.SphereShape(RADIUS), RADIUS + drop, Jolt.EMotionType_Dynamic, 1);
    const heights = [];
    for (let k = 0; k < steps; k++) {
      engine.Step(step, 1);
      heights.push(ball.GetPosition().GetY() - RADIUS);
    }
    Jolt.destroy(engine);
    return heights;
  };
}

async function physx(threshold) {
  // The package is made for browsers, and refuses to start where it sees Node.js.
  const node = globalThis.process;
  globalThis.window = globalThis;
  globalThis.location ??= { href: "" };
  const wasmBinary = readFileSync(place.resolve("physx-js-webidl/physx-js-webidl.wasm"));
  globalThis.process = undefined;
  const PhysX = await (await import("physx-js-webidl")).default({ wasmBinary });
  globalThis.process = node;
  const report = new PhysX.PxDefaultErrorCallback();
  const version = PhysX.PHYSICS_VERSION;
  const base = PhysX.CreateFoundation(version, new PhysX.PxDefaultAllocator(), report);
  const scale = new PhysX.PxTolerancesScale();
  const physics = PhysX.CreatePhysics(version, base, scale);
  const { eSCENE_QUERY_SHAPE, eSIMULATION_SHAPE } = PhysX.PxShapeFlagEnum;
  const flags = new PhysX.PxShapeFlags(eSCENE_QUERY_SHAPE | eSIMULATION_SHAPE);
  return (r, step, drop, steps) => {
    const made = new PhysX.PxSceneDesc(scale);
    made.gravity = new PhysX.PxVec3(0, -G, 0);
    made.cpuDispatcher = PhysX.DefaultCpuDispatcherCreate(0);
    made.filterShader = PhysX.DefaultFilterShader();
    if (threshold) made.bounceThresholdVelocity = threshold;
    const scene = physics.createScene(made);
    const material = physics.createMaterial(0.5, 0.5, r);
    const put = (geometry, y, create) => {
      const pose = new PhysX.PxTransform(PhysX.PxIDENTITYEnum.PxIdentity);
      pose.p = new PhysX.PxVec3(0, y, 0);
      const body = physics[create](pose);
      const shape = physics.createShape(geometry, material, true, flags);
      shape.setSimulationFilterData(new PhysX.PxFilterData(1, 1, 0, 0));
      body.attachShape(shape);
      scene.addActor(body);
      return body;
    };
    put(new PhysX.PxBoxGeometry(9, 1, 9), -1, "createRigidStatic");
    const ball = put(new PhysX.PxSphereGeometry(RADIUS), RADIUS + drop, "createRigidDynamic");
    const heights = [];
    for (let k = 0; k < steps; k++) {
      scene.simulate(step);
      scene.fetchResults(true);
      heights.push(ball.getGlobalPose().p.y - RADIUS);
    }
    scene.release();
    return heights;
  };
}

async function box2d() {
  const Box2D = await (await import("box2d3-wasm")).default();
  return (r, step, drop, steps) => {
    const made = Box2D.b2DefaultWorldDef();
    made.gravity.Set(0, -G);
    const world = Box2D.b2CreateWorld(made);
    const put = (y, type) => {
      const body = Box2D.b2DefaultBodyDef();
      body.type = type;
      body.position.Set(0, y);
      const shape = Box2D.b2DefaultShapeDef();
      shape.material.restitution = r;
      return [Box2D.b2CreateBody(world, body), shape];
    };
    const [ground, floor] = put(-1, Box2D.b2BodyType.b2_staticBody);
    Box2D.b2CreatePolygonShape(ground, floor, Box2D.b2MakeBox(9, 1));
    const [ball, round] = put(RADIUS + drop, Box2D.b2BodyType.b2_dynamicBody);
    const circle = new Box2D.b2Circle();
    circle.center.Set(0, 0);
    circle.radius = RADIUS;
    Box2D.b2CreateCircleShape(ball, round, circle);
    const heights = [];
    for (let k = 0; k < steps; k++) {
      Box2D.b2World_Step(world, step, 4);
      heights.push(Box2D.b2Body_GetPosition(ball).y - RADIUS);
    }
    Box2D.b2DestroyWorld(world);
    return heights;
  };
}

function got(run, r, step, drop) {
  const speed = Math.sqrt(2 * G * drop);
  const found = [...Array(8).keys()].map((k) => {
    const height = drop + speed * step * (k / 8 - 0.5);
    const heights = run(r, step, height, Math.ceil((2.2 * speed) / G / step));
    const rising = heights.findIndex((z, i) => z > heights[i - 1]);
    return Math.sqrt(Math.max(...heights.slice(rising), 0) / height);
  });
  return [found.reduce((a, b) => a + b) / 8, Math.min(...found), Math.max(...found)];
}

const ENGINES = [
  ["Jolt", "jolt-physics 1.1.0", jolt],
  ["PhysX 5.6.1", "physx-js-webidl 2.7.3", () => physx(0)],
  ["PhysX 5.6.1 with bounceThresholdVelocity = 0.01", "physx-js-webidl 2.7.3", () => physx(0.01)],
  ["Box2D 3", "box2d3-wasm 5.2.0", box2d],
];
console.log("engine,package,time step in s,drop in m,r,mean,least,greatest");
for (const [name, from, make] of ENGINES) {
  const run = await make();
  for (const step of [60, 240, 1000])
    for (const drop of [0.1, 1])
      for (const r of [0.3, 0.5, 0.75, 0.9, 1]) {
        const numbers = got(run, r, 1 / step, drop).map((x) => x.toFixed(4));
        console.log([name, from, `1/${step}`, drop, r, ...numbers].join(","));
      }
}
