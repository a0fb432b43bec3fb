// A ball or a box falls on a plane in the ODE of Gazebo Classic with the numbers that Gazebo gives
// it; engine_runs.py calls this program as engine_gazebo, if it is on the PATH.
//
// Its arguments are the radius or half height, the mass, the gap, the speed, gravity, kp, kd, restitution_coefficient, threshold and max_vel of both bodies, the
// world's contact_max_correcting_vel, 1 for a box or 0, the step and the number of steps, in SI
// units. It writes the gap after each step into the file heights.txt.

#include <cstdlib>
#include <fstream>

#include <gazebo/ode/ode.h>

int main(int, char* argv[]) {
    double values[14];
    for (int i = 0; i < 14; i++)
        values[i] = std::atof(argv[i + 1]);
    const auto [radius, mass, gap, speed, gravity, kp, kd, bounce, threshold, fastest,
                correcting, is_box, step, steps] = values;

    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    dWorldID world = dWorldCreate();
    dWorldSetGravity(world, 0, 0, -gravity);
    // The defaults of a world of Gazebo.
    dWorldSetQuickStepInertiaRatioReduction(world, true);
    dWorldSetContactMaxCorrectingVel(world, correcting);
    dWorldSetContactSurfaceLayer(world, 0.001);
    dWorldSetCFM(world, 0);
    dWorldSetERP(world, 0.2);
    dWorldSetQuickStepNumIterations(world, 50);
    dWorldSetQuickStepW(world, 1.3);

    dBodyID body = dBodyCreate(world);
    dMass inertia;
    if (is_box)
        dMassSetBoxTotal(&inertia, mass, 2 * radius, 2 * radius, 2 * radius);
    else
        dMassSetSphereTotal(&inertia, mass, radius);
    dBodySetMass(body, &inertia);
    dBodySetPosition(body, 0, 0, radius + gap);
    dBodySetLinearDamping(body, 0);
    dBodySetMaxVel(body, fastest);
    dBodySetMinDepth(body, 0);
    dGeomID shape = is_box ? dCreateBox(nullptr, 2 * radius, 2 * radius, 2 * radius)
                           : dCreateSphere(nullptr, radius);
    dGeomSetBody(shape, body);
    dBodySetLinearVel(body, 0, 0, -speed);
    dGeomID plane = dCreatePlane(nullptr, 0, 0, 1, 0);

    // As ODEPhysics::Collide combines the numbers of two bodies.
    dContact contact = {};
    contact.surface.mode = dContactBounce | dContactMu2 | dContactSoftERP | dContactSoftCFM |
                           dContactApprox1 | dContactSlip1 | dContactSlip2;
    contact.surface.mu = 1;
    contact.surface.mu2 = 1;
    const double stiffness = kp / 2;
    const double damping = 2 * kd;
    contact.surface.soft_erp = step * stiffness / (step * stiffness + damping);
    contact.surface.soft_cfm = 1 / (step * stiffness + damping);
    contact.surface.bounce = bounce;
    contact.surface.bounce_vel = threshold;

    // Gazebo takes 10 points of a pair by default, more than a box on a plane has.
    dContactGeom points[10];
    dJointGroupID group = dJointGroupCreate(0);
    std::ofstream heights("heights.txt");
    heights.precision(15);
    for (int i = 0; i < steps; i++) {
        const int count = dCollide(shape, plane, 10, points, sizeof(dContactGeom));
        for (int j = 0; j < count; j++) {
            contact.geom = points[j];
            dJointID joint = dJointCreateContact(world, group, &contact);
            dJointAttach(joint, body, nullptr);
        }
        dWorldQuickStep(world, step);
        dJointGroupEmpty(group);
        heights << dBodyGetPosition(body)[2] - radius << '\n';
    }
}
