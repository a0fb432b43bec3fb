// Balls that are dropped in engines that have a package for JavaScript. It prints the lines of
// engine_drops.csv of these engines, measured again:
//   npm install @dimforge/rapier3d-compat@0.21.0 jolt-physics@1.1.0 box2d3-wasm@5.2.0 \
//     physx-js-webidl@2.7.3 planck@1.4.2 matter-js@0.20.0 cannon-es@0.20.0
//   node engine_drops.mjs [ENGINE]...        (with engine_drops.csv, beside node_modules)
// An engine takes r, a step in s, a drop and a radius in m, and the number of steps, and returns the
// heights of the ball over the surface.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const G = 9.81;
const INSTANTS = 8;
const place = createRequire(import.meta.url);
const load = async (name) => {
  const found = await import(name);
  return found.default ?? found;
};

async function rapier() {
  const Rapier = await load("@dimforge/rapier3d-compat");
  await Rapier.init();
  return (r, step, drop, radius, steps) => {
    const world = new Rapier.World({ x: 0, y: -G, z: 0 });
    world.timestep = step;
    const ground = Rapier.ColliderDesc.cuboid(9, 1, 9).setTranslation(0, -1, 0);
    world.createCollider(ground.setRestitution(r));
    const body = Rapier.RigidBodyDesc.dynamic().setTranslation(0, radius + drop, 0);
    const ball = world.createRigidBody(body.setCanSleep(false));
    world.createCollider(Rapier.ColliderDesc.ball(radius).setRestitution(r), ball);
    const heights = [];
    for (let k = 0; k < steps; k++) {
      world.step();
      heights.push(ball.translation().y - radius);
    }
    world.free();
    return heights;
  };
}

async function jolt() {
  const Jolt = await (await load("jolt-physics"))();
  return (r, step, drop, radius, steps) => {
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
      made.mAllowSleeping = false;
      const body = bodies.CreateBody(made);
      bodies.AddBody(body.GetID(), Jolt.EActivation_Activate);
      return body;
    };
    put(new Jolt.BoxShape(new Jolt.Vec3(9, 1, 9)), -1, Jolt.EMotionType_Static, 0);
    const ball = put(new Jolt.SphereShape(radius), radius + drop, Jolt.EMotionType_Dynamic, 1);
    const heights = [];
    for (let k = 0; k < steps; k++) {
      engine.Step(step, 1);
      heights.push(ball.GetPosition().GetY() - radius);
    }
    Jolt.destroy(engine);
    return heights;
  };
}

async function physx(threshold, offset) {
  // The package is made for browsers, and refuses to start where it sees Node.js.
  const node = globalThis.process;
  globalThis.window = globalThis;
  globalThis.location ??= { href: "" };
  const wasmBinary = readFileSync(place.resolve("physx-js-webidl/physx-js-webidl.wasm"));
  globalThis.process = undefined;
  const PhysX = await (await load("physx-js-webidl"))({ wasmBinary });
  globalThis.process = node;
  const report = new PhysX.PxDefaultErrorCallback();
  const version = PhysX.PHYSICS_VERSION;
  const base = PhysX.CreateFoundation(version, new PhysX.PxDefaultAllocator(), report);
  const scale = new PhysX.PxTolerancesScale();
  const physics = PhysX.CreatePhysics(version, base, scale);
  const { eSCENE_QUERY_SHAPE, eSIMULATION_SHAPE } = PhysX.PxShapeFlagEnum;
  const flags = new PhysX.PxShapeFlags(eSCENE_QUERY_SHAPE | eSIMULATION_SHAPE);
  return (r, step, drop, radius, steps) => {
    const made = new PhysX.PxSceneDesc(scale);
    made.gravity = new PhysX.PxVec3(0, -G, 0);
    made.cpuDispatcher = PhysX.DefaultCpuDispatcherCreate(0);
    made.filterShader = PhysX.DefaultFilterShader();
    made.bounceThresholdVelocity = threshold;
    const scene = physics.createScene(made);
    const material = physics.createMaterial(0.5, 0.5, r);
    const put = (geometry, y, create) => {
      const pose = new PhysX.PxTransform(PhysX.PxIDENTITYEnum.PxIdentity);
      pose.p = new PhysX.PxVec3(0, y, 0);
      const body = physics[create](pose);
      const shape = physics.createShape(geometry, material, true, flags);
      shape.setSimulationFilterData(new PhysX.PxFilterData(1, 1, 0, 0));
      shape.setContactOffset(offset);
      body.attachShape(shape);
      scene.addActor(body);
      return body;
    };
    put(new PhysX.PxBoxGeometry(9, 1, 9), -1, "createRigidStatic");
    const ball = put(new PhysX.PxSphereGeometry(radius), radius + drop, "createRigidDynamic");
    const heights = [];
    for (let k = 0; k < steps; k++) {
      scene.simulate(step);
      scene.fetchResults(true);
      heights.push(ball.getGlobalPose().p.y - radius);
    }
    scene.release();
    return heights;
  };
}

async function box2d() {
  const Box2D = await (await load("box2d3-wasm"))();
  return (r, step, drop, radius, steps) => {
    const made = Box2D.b2DefaultWorldDef();
    made.gravity.Set(0, -G);
    const world = Box2D.b2CreateWorld(made);
    const put = (y, type) => {
      const body = Box2D.b2DefaultBodyDef();
      body.type = type;
      body.enableSleep = false;
      body.position.Set(0, y);
      const shape = Box2D.b2DefaultShapeDef();
      shape.material.restitution = r;
      return [Box2D.b2CreateBody(world, body), shape];
    };
    const [ground, floor] = put(-1, Box2D.b2BodyType.b2_staticBody);
    Box2D.b2CreatePolygonShape(ground, floor, Box2D.b2MakeBox(9, 1));
    const [ball, round] = put(radius + drop, Box2D.b2BodyType.b2_dynamicBody);
    const circle = new Box2D.b2Circle();
    circle.center.Set(0, 0);
    circle.radius = radius;
    Box2D.b2CreateCircleShape(ball, round, circle);
    const heights = [];
    for (let k = 0; k < steps; k++) {
      Box2D.b2World_Step(world, step, 4);
      heights.push(Box2D.b2Body_GetPosition(ball).y - radius);
    }
    Box2D.b2DestroyWorld(world);
    return heights;
  };
}

async function planck() {
  const Planck = await load("planck");
  return (r, step, drop, radius, steps) => {
    const world = new Planck.World({ gravity: Planck.Vec2(0, -G) });
    const ground = new Planck.Box(9, 1, Planck.Vec2(0, -1));
    world.createBody().createFixture({ shape: ground, restitution: r });
    const ball = world.createDynamicBody({ position: Planck.Vec2(0, radius + drop) });
    ball.createFixture({ shape: new Planck.Circle(radius), density: 1, restitution: r });
    const heights = [];
    for (let k = 0; k < steps; k++) {
      world.step(step);
      heights.push(ball.getPosition().y - radius);
    }
    return heights;
  };
}

async function matter() {
  const Matter = await load("matter-js");
  return (r, step, drop, radius, steps) => {
    // A circle is a polygon of at most 200 sides there, one for each pixel of its radius.
    const pixels = 200 / radius;
    const engine = Matter.Engine.create({ gravity: { x: 0, y: 1, scale: G * pixels * 1e-6 } });
    const bodies = Matter.Bodies;
    const smooth = { restitution: r, friction: 0, frictionAir: 0 };
    const ground = bodies.rectangle(0, 1e5, 2e6, 2e5, { ...smooth, isStatic: true });
    const ball = bodies.circle(0, -(radius + drop) * pixels, radius * pixels, smooth, 200);
    Matter.Composite.add(engine.world, [ground, ball]);
    const heights = [];
    for (let k = 0; k < steps; k++) {
      Matter.Engine.update(engine, step * 1000);
      heights.push(-ball.position.y / pixels - radius);
    }
    return heights;
  };
}

async function cannon() {
  const Cannon = await load("cannon-es");
  return (r, step, drop, radius, steps) => {
    const world = new Cannon.World({ gravity: new Cannon.Vec3(0, -G, 0) });
    world.defaultContactMaterial.restitution = r;
    world.defaultContactMaterial.friction = 0;
    const ground = new Cannon.Body({ mass: 0, shape: new Cannon.Plane() });
    ground.quaternion.setFromEuler(-Math.PI / 2, 0, 0);
    world.addBody(ground);
    const ball = new Cannon.Body({
      mass: 1,
      shape: new Cannon.Sphere(radius),
      position: new Cannon.Vec3(0, radius + drop, 0),
      linearDamping: 0,
    });
    world.addBody(ball);
    const heights = [];
    for (let k = 0; k < steps; k++) {
      world.step(step);
      heights.push(ball.position.y - radius);
    }
    return heights;
  };
}

const ENGINES = {
  rapier,
  jolt,
  physx: () => physx(2, 0.02),
  unity: () => physx(2, 0.01),
  "isaac-lab": () => physx(0.5, 1),
  // PhysX wants a threshold above 0; every impact here is faster than this one.
  "isaac-sim": () => physx(0.2, 1),
  box2d,
  planck,
  "matter-js": matter,
  "cannon-es": cannon,
};

/** The height of the first top after the first impact; 0 if the ball does not fall again. */
function rebound(heights) {
  const first = heights.findIndex((z, i) => z > heights[i - 1]);
  if (first < 0) return 0;
  const top = heights.findIndex((z, i) => i > first && z < heights[i - 1]);
  return top < 0 ? 0 : Math.max(heights[top - 1], 0);
}

function dropped(run, r, step, drop, radius) {
  const speed = Math.sqrt(2 * G * drop);
  const steps = Math.ceil((2.4 * speed) / G / step) + 6;
  const found = [...Array(INSTANTS).keys()].map((k) => {
    const height = drop + speed * step * (k / INSTANTS - 0.5);
    return Math.sqrt(rebound(run(r, step, height, radius, steps)) / height);
  });
  return [found.reduce((a, b) => a + b) / INSTANTS, Math.min(...found), Math.max(...found)];
}

const table = readFileSync(new URL("engine_drops.csv", import.meta.url), "utf8");
const lines = table.trim().split("\n").slice(1).map((line) => line.split(","));
const cases = new Set(lines.map((line) => line.slice(1, 5).join(",")));
const wanted = process.argv.slice(2);
for (const [name, make] of Object.entries(ENGINES)) {
  if (wanted.length && !wanted.includes(name)) continue;
  const run = await make();
  for (const each of cases) {
    const [r, rate, drop, radius] = each.split(",").map(Number);
    const numbers = dropped(run, r, 1 / rate, drop, radius).map((x) => x.toFixed(4));
    console.log([name, each, ...numbers].join(","));
  }
}
