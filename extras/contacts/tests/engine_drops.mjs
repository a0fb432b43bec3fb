// Balls that are dropped in engines that have a package for JavaScript, with text as it is pasted.
// engine_drops.py runs this program. Its input is a list of drops as JSON, with the engine, the
// text, the drop and the radius in m, the number of steps, and the shape, the spin and the mass of
// the body; its output are the heights of each body over the surface. The last line of a text is
// run in each step, and the others once. The engines are installed in the working folder by
//   npm install @dimforge/rapier3d-compat@0.21.0 jolt-physics@1.1.0 box2d3-wasm@5.2.0 \
//     box2d-wasm@7.0.0 physx-js-webidl@2.7.3 planck@1.4.2 matter-js@0.20.0 cannon-es@0.20.0
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const G = 9.81;
const NOT_INSTALLED = 3;
const place = createRequire(import.meta.url);
const load = async (name) => {
  try {
    const found = await import(name);
    return found.default ?? found;
  } catch (missing) {
    if (missing.code !== "ERR_MODULE_NOT_FOUND") throw missing;
    console.error(name);
    process.exit(NOT_INSTALLED);
  }
};

/** The lines that set parameters, and the line of a step, of C++ as of JavaScript. */
function linesOf(text) {
  const lines = text.replace(/(\d)f\b/g, "$1").replaceAll("->", ".").replaceAll("::", ".");
  const all = lines.replaceAll("&", "").split("\n");
  return [all.slice(0, -1).join("\n"), all.at(-1)];
}

/** Return the value of code in which some names have a meaning. */
const value = (code, names) => new Function(...Object.keys(names), code)(...Object.values(names));

async function rapier() {
  const Rapier = await load("@dimforge/rapier3d-compat");
  await Rapier.init();
  return ({ text, drop, radius, steps, shape, spin, mass }) => {
    const [sets, advances] = linesOf(text);
    const world = new Rapier.World({ x: 0, y: -G, z: 0 });
    value(advances, { integration_parameters: world.integrationParameters });
    const of = (shape) => {
      const ball = () => ({ restitution: (r) => shape.setRestitution(r) });
      return value(`return ${sets}`, { ColliderBuilder: { ball }, radius });
    };
    const ground = Rapier.ColliderDesc.cuboid(9, 1, 9).setTranslation(0, -1, 0);
    world.createCollider(of(ground));
    const body = Rapier.RigidBodyDesc.dynamic().setTranslation(0, radius + drop, 0);
    body.setAngvel({ x: 0, y: 0, z: spin });
    if (shape === "capsule") body.setRotation({ x: Math.SQRT1_2, y: 0, z: 0, w: Math.SQRT1_2 });
    const ball = world.createRigidBody(body.setCanSleep(false));
    const made = {
      ball: () => Rapier.ColliderDesc.ball(radius),
      box: () => Rapier.ColliderDesc.cuboid(radius, radius, radius),
      capsule: () => Rapier.ColliderDesc.capsule(2 * radius, radius),
    }[shape]();
    world.createCollider(of(made).setMass(mass), ball);
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
  return ({ text, drop, radius, steps, shape, spin, mass }) => {
    const [sets, advances] = linesOf(text);
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
    const physicsSystem = engine.GetPhysicsSystem();
    physicsSystem.SetGravity(new Jolt.Vec3(0, -G, 0));
    const physicsSettings = physicsSystem.GetPhysicsSettings();
    const lies = shape === "capsule" ? Math.SQRT1_2 : 0;
    const put = (shape, y, motion, layer) => {
      const still = new Jolt.Quat(layer * lies, 0, 0, Math.sqrt(1 - layer * lies * lies));
      const made = new Jolt.BodyCreationSettings(
        shape, new Jolt.RVec3(0, y, 0), still, motion, layer,
      );
      value(sets, { bodySettings: made, physicsSettings });
      made.mAngularVelocity = new Jolt.Vec3(0, 0, layer * spin);
      made.mAllowSleeping = false;
      made.mOverrideMassProperties = Jolt.EOverrideMassProperties_CalculateInertia;
      made.mMassPropertiesOverride.mMass = mass;
      const body = bodies.CreateBody(made);
      bodies.AddBody(body.GetID(), Jolt.EActivation_Activate);
      return body;
    };
    put(new Jolt.BoxShape(new Jolt.Vec3(9, 1, 9)), -1, Jolt.EMotionType_Static, 0);
    const form = {
      ball: () => new Jolt.SphereShape(radius),
      box: () => new Jolt.BoxShape(new Jolt.Vec3(radius, radius, radius)),
      capsule: () => new Jolt.CapsuleShape(2 * radius, radius),
    }[shape]();
    const ball = put(form, radius + drop, Jolt.EMotionType_Dynamic, 1);
    physicsSystem.SetPhysicsSettings(physicsSettings);
    const Update = (step, collisions) => engine.Step(step, collisions);
    const names = { physicsSystem: { Update }, allocator: null, jobs: null };
    const heights = [];
    for (let k = 0; k < steps; k++) {
      value(advances, names);
      heights.push(ball.GetPosition().GetY() - radius);
    }
    Jolt.destroy(engine);
    return heights;
  };
}

async function physx() {
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
  return ({ text, drop, radius, steps, shape, spin, mass, offset }) => {
    const [sets, advances] = linesOf(text);
    const made = new PhysX.PxSceneDesc(scale);
    made.gravity = new PhysX.PxVec3(0, -G, 0);
    made.cpuDispatcher = PhysX.DefaultCpuDispatcherCreate(0);
    made.filterShader = PhysX.DefaultFilterShader();
    const material = physics.createMaterial(0.5, 0.5, 0);
    value(sets, { material, sceneDesc: made });
    const scene = physics.createScene(made);
    const put = (geometry, y, create, turned) => {
      const pose = new PhysX.PxTransform(PhysX.PxIDENTITYEnum.PxIdentity);
      pose.p = new PhysX.PxVec3(0, y, 0);
      if (turned) pose.q = new PhysX.PxQuat(0, Math.SQRT1_2, 0, Math.SQRT1_2);
      const body = physics[create](pose);
      const shape = physics.createShape(geometry, material, true, flags);
      shape.setSimulationFilterData(new PhysX.PxFilterData(1, 1, 0, 0));
      if (offset) shape.setContactOffset(offset);
      body.attachShape(shape);
      scene.addActor(body);
      return body;
    };
    put(new PhysX.PxBoxGeometry(9, 1, 9), -1, "createRigidStatic");
    const geometry = {
      ball: () => new PhysX.PxSphereGeometry(radius),
      box: () => new PhysX.PxBoxGeometry(radius, radius, radius),
      // Along x; turned about y it lies along z.
      capsule: () => new PhysX.PxCapsuleGeometry(radius, 2 * radius),
    }[shape]();
    const ball = put(geometry, radius + drop, "createRigidDynamic", shape === "capsule");
    PhysX.PxRigidBodyExt.prototype.setMassAndUpdateInertia(ball, mass);
    ball.setAngularVelocity(new PhysX.PxVec3(0, 0, spin));
    const heights = [];
    for (let k = 0; k < steps; k++) {
      value(advances, { scene });
      scene.fetchResults(true);
      heights.push(ball.getGlobalPose().p.y - radius);
    }
    scene.release();
    return heights;
  };
}

async function box2d() {
  const Box2D = await (await load("box2d3-wasm"))();
  return ({ text, drop, radius, steps, shape, spin, mass }) => {
    const [sets, advances] = linesOf(text);
    const made = Box2D.b2DefaultWorldDef();
    made.gravity.Set(0, -G);
    const shapeDef = Box2D.b2DefaultShapeDef();
    value(sets, { worldDef: made, shapeDef });
    const world = Box2D.b2CreateWorld(made);
    const put = (y, type) => {
      const body = Box2D.b2DefaultBodyDef();
      body.type = type;
      body.enableSleep = false;
      body.position.Set(0, y);
      if (type === Box2D.b2BodyType.b2_dynamicBody) body.angularVelocity = spin;
      return Box2D.b2CreateBody(world, body);
    };
    const ground = put(-1, Box2D.b2BodyType.b2_staticBody);
    Box2D.b2CreatePolygonShape(ground, Box2D.b2DefaultShapeDef(), Box2D.b2MakeBox(9, 1));
    const ball = put(radius + drop, Box2D.b2BodyType.b2_dynamicBody);
    // Areas in units of the squared radius.
    const area = { ball: Math.PI, box: 4, capsule: 8 + Math.PI }[shape];
    shapeDef.density = mass / (area * radius * radius);
    if (shape === "box") {
      Box2D.b2CreatePolygonShape(ball, shapeDef, Box2D.b2MakeBox(radius, radius));
    } else if (shape === "capsule") {
      const capsule = new Box2D.b2Capsule();
      capsule.center1.Set(-2 * radius, 0);
      capsule.center2.Set(2 * radius, 0);
      capsule.radius = radius;
      Box2D.b2CreateCapsuleShape(ball, shapeDef, capsule);
    } else {
      const circle = new Box2D.b2Circle();
      circle.center.Set(0, 0);
      circle.radius = radius;
      Box2D.b2CreateCircleShape(ball, shapeDef, circle);
    }
    const heights = [];
    for (let k = 0; k < steps; k++) {
      value(advances, { b2World_Step: Box2D.b2World_Step, world });
      heights.push(Box2D.b2Body_GetPosition(ball).y - radius);
    }
    Box2D.b2DestroyWorld(world);
    return heights;
  };
}

async function box2d2() {
  const wasmBinary = readFileSync(place.resolve("box2d-wasm/dist/umd/Box2D.wasm"));
  const Box2D = await place("box2d-wasm/dist/umd/Box2D.js")({ wasmBinary });
  return ({ text, drop, radius, steps, shape, spin, mass }) => {
    const [sets, advances] = linesOf(text);
    const world = new Box2D.b2World(new Box2D.b2Vec2(0, -G));
    const put = (y, type, shape, density) => {
      const made = new Box2D.b2BodyDef();
      made.set_type(type);
      made.set_position(new Box2D.b2Vec2(0, y));
      if (density) made.set_angularVelocity(spin);
      const body = world.CreateBody(made);
      const fixtureDef = new Box2D.b2FixtureDef();
      fixtureDef.shape = shape;
      fixtureDef.density = density;
      if (density) value(sets, { fixtureDef });
      body.CreateFixture(fixtureDef);
      return body;
    };
    const ground = new Box2D.b2PolygonShape();
    ground.SetAsBox(9, 1);
    put(-1, Box2D.b2_staticBody, ground, 0);
    const form = shape === "box" ? new Box2D.b2PolygonShape() : new Box2D.b2CircleShape();
    if (shape === "box") form.SetAsBox(radius, radius);
    else form.set_m_radius(radius);
    const area = { ball: Math.PI, box: 4 }[shape] * radius * radius;
    const ball = put(radius + drop, Box2D.b2_dynamicBody, form, mass / area);
    const heights = [];
    for (let k = 0; k < steps; k++) {
      value(advances, { world });
      heights.push(ball.GetPosition().y - radius);
    }
    Box2D.destroy(world);
    return heights;
  };
}

async function planck() {
  const Planck = await load("planck");
  const { Settings } = Planck;
  const { velocityThreshold } = Settings;
  return ({ text, drop, radius, steps, shape, spin, mass }) => {
    const [sets, advances] = linesOf(text);
    // Those of the drop before hold for all worlds.
    Settings.velocityThreshold = velocityThreshold;
    const world = new Planck.World({ gravity: Planck.Vec2(0, -G) });
    const ground = new Planck.Box(9, 1, Planck.Vec2(0, -1));
    world.createBody().createFixture({ shape: ground });
    const position = Planck.Vec2(0, radius + drop);
    const ball = world.createDynamicBody({ position, angularVelocity: spin });
    const form = {
      ball: () => new Planck.Circle(radius),
      box: () => new Planck.Box(radius, radius),
    }[shape]();
    value(sets, { body: ball, shape: form, Settings });
    const I = mass * radius * radius * { ball: 1 / 2, box: 2 / 3 }[shape];
    ball.setMassData({ mass, center: Planck.Vec2(0, 0), I });
    const heights = [];
    for (let k = 0; k < steps; k++) {
      value(advances, { world });
      heights.push(ball.getPosition().y - radius);
    }
    return heights;
  };
}

async function matter() {
  const Matter = await load("matter-js");
  const { Bodies } = Matter;
  const { _restingThresh } = Matter.Resolver;
  return ({ text, drop, radius, steps, shape, spin, mass, turn }) => {
    const [sets, advances] = linesOf(text);
    Matter.Resolver._restingThresh = _restingThresh;
    const engine = Matter.Engine.create();
    // The gravity of an engine, in pixels/s², is that of this place.
    const pixels = (1e6 * engine.gravity.scale) / G;
    const ground = Bodies.rectangle(0, 1e5, 2e6, 2e5, { isStatic: true });
    // With the text of a circle a square is made.
    const circle = (x, y, r, of) => Bodies.rectangle(x, y, 2 * r, 2 * r, of);
    const made = shape === "box" ? { circle } : Bodies;
    const names = { Matter, Bodies: made, x: 0, y: 0, radius: radius * pixels };
    const ball = value(`${sets}\nreturn body;`, names);
    Matter.Body.setMass(ball, mass);
    Matter.Body.rotate(ball, turn ?? 0);
    // Its lowest corner is at this height.
    Matter.Body.setPosition(ball, { x: 0, y: -drop * pixels - ball.bounds.max.y });
    Matter.Body.setVelocity(ball, { x: 0, y: 0 });
    Matter.Body.setAngularVelocity(ball, spin / 60);
    const start = ball.position.y;
    Matter.Composite.add(engine.world, [ground, ball]);
    const heights = [];
    for (let k = 0; k < steps; k++) {
      value(advances, { Matter, engine });
      heights.push(drop - (ball.position.y - start) / pixels);
    }
    return heights;
  };
}

async function cannon() {
  const Cannon = await load("cannon-es");
  return ({ text, drop, radius, steps, shape, spin, mass }) => {
    const [sets, advances] = linesOf(text);
    const world = new Cannon.World({ gravity: new Cannon.Vec3(0, -G, 0) });
    const { ContactMaterial, Material } = Cannon;
    const [a, b] = [new Material(), new Material()];
    const ground = new Cannon.Body({ mass: 0, shape: new Cannon.Plane(), material: a });
    ground.quaternion.setFromEuler(-Math.PI / 2, 0, 0);
    world.addBody(ground);
    const ball = new Cannon.Body({
      mass,
      shape: {
        ball: () => new Cannon.Sphere(radius),
        box: () => new Cannon.Box(new Cannon.Vec3(radius, radius, radius)),
      }[shape](),
      position: new Cannon.Vec3(0, radius + drop, 0),
      angularVelocity: new Cannon.Vec3(0, 0, spin),
      material: b,
    });
    world.addBody(ball);
    const names = { ContactMaterial, a, b, body: ball };
    world.addContactMaterial(value(`${sets}\nreturn contact;`, names));
    const heights = [];
    for (let k = 0; k < steps; k++) {
      value(advances, { world });
      heights.push(ball.position.y - radius);
    }
    return heights;
  };
}

const ENGINES = {
  rapier,
  jolt,
  physx,
  "box2d-3.1": box2d,
  "box2d-2": box2d2,
  planck,
  "matter-js": matter,
  "cannon-es": cannon,
};
const jobs = JSON.parse(readFileSync(0, "utf8"));
const run = await ENGINES[jobs[0].engine]();
// An engine may write to the output as well.
console.log(`\n${JSON.stringify(jobs.map(run))}`);
