from pydrake import all as drake

builder, config = drake.DiagramBuilder(), drake.MultibodyPlantConfig(time_step=1e-4)
config.contact_model, config.discrete_contact_approximation = "point", "sap"
plant, _ = drake.AddMultibodyPlant(config, builder)
plant.mutable_gravity_field().set_gravity_vector([0, 0, -9.81])
ball = plant.AddRigidBody("ball", drake.SpatialInertia.SolidSphereWithMass(1.0, 0.1))
own, at = drake.ProximityProperties(), drake.RigidTransform()
drake.AddContactMaterial(point_stiffness=2e4, friction=drake.CoulombFriction(), properties=own)
own.AddProperty("material", "relaxation_time", (20 / 1e4 - 1e-4) / 2)
for body, shape in ((plant.world_body(), drake.HalfSpace()), (ball, drake.Sphere(0.1))):
    plant.RegisterCollisionGeometry(body, at, shape, body.name(), own)
plant.Finalize()
log = drake.LogVectorOutput(plant.get_state_output_port(), builder, 1e-4)
plant.SetDefaultFloatingBaseBodyPose(ball, drake.RigidTransform([0, 0, 1.1]))
simulator = drake.Simulator(builder.Build())
simulator.AdvanceTo(1.1)
heights = log.FindLog(simulator.get_context()).data()[6, 1:] - 0.1
