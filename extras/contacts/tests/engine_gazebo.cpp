// A ball or a box falls on a plane, or two balls meet, in the ODE of Gazebo Classic with the numbers
// that Gazebo gives it; engine_runs.py calls this program as engine_gazebo, if it is on the PATH.
//
// Its arguments are the radius or half height, the mass, the other mass (0 for a plane), the gap,
// the speed, gravity, kp, kd, restitution_coefficient, threshold and max_vel of both bodies, the
// world's contact_max_correcting_vel, 1 for a box or 0, the step and the number of steps, in SI
// units. It writes the gap after each step into the file heights.txt.

#include <cstdlib>
#include <fstream>

#include <gazebo/ode/ode.h>

int main(int, char* argv[]) {
    double values[15];
    for (int i = 0; i < 15; i++)
        values[i] = std::atof(argv[i + 1]);
    const auto [radius, mass, other, gap, speed, gravity, kp, kd, bounce, threshold, fastest,
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

    dBodyID bodies[2] = {nullptr, nullptr};
    dGeomID shapes[2];
    const double masses[2] = {mass, other};
    const double places[2] = {radius + gap, -radius};
    for (int i = 0; i < (other > 0 ? 2 : 1); i++) {
        bodies[i] = dBodyCreate(world);
        dMass inertia;
        if (is_box)
            dMassSetBoxTotal(&inertia, masses[i], 2 * radius, 2 * radius, 2 * radius);
        else
            dMassSetSphereTotal(&inertia, masses[i], radius);
        dBodySetMass(bodies[i], &inertia);
        dBodySetPosition(bodies[i], 0, 0, places[i]);
        dBodySetLinearDamping(bodies[i], 0);
        dBodySetMaxVel(bodies[i], fastest);
        dBodySetMinDepth(bodies[i], 0);
        shapes[i] = is_box ? dCreateBox(nullptr, 2 * radius, 2 * radius, 2 * radius)
                           : dCreateSphere(nullptr, radius);
        dGeomSetBody(shapes[i], bodies[i]);
    }
    dBodySetLinearVel(bodies[0], 0, 0, -speed);
    if (other == 0)
        shapes[1] = dCreatePlane(nullptr, 0, 0, 1, 0);

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
        const int count = dCollide(shapes[0], shapes[1], 10, points, sizeof(dContactGeom));
        for (int j = 0; j < count; j++) {
            contact.geom = points[j];
            dJointID joint = dJointCreateContact(world, group, &contact);
            dJointAttach(joint, bodies[0], bodies[1]);
        }
        dWorldQuickStep(world, step);
        dJointGroupEmpty(group);
        const double below = other > 0 ? dBodyGetPosition(bodies[1])[2] + radius : 0;
        heights << dBodyGetPosition(bodies[0])[2] - radius - below << '\n';
    }
}
