// Balls of the models in a world of SDF fall, in the physics of Gazebo (Ignition) with its plugin of
// DART; engine_drops.py calls this program as engine_gz_sim, if it is on the PATH.
//
// Its arguments are the file of the plugin, the file of the world, the step in s and the number of
// steps. It prints the heights of the models but the first one, the ground, after each step.
//
// It is built with the flags that pkg-config has for ignition-physics5, ignition-physics5-sdf,
// ignition-plugin1-loader and sdformat12, all packages of Debian.

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include <ignition/physics/ForwardStep.hh>
#include <ignition/physics/FrameSemantics.hh>
#include <ignition/physics/GetEntities.hh>
#include <ignition/physics/RequestEngine.hh>
#include <ignition/physics/sdf/ConstructWorld.hh>
#include <ignition/plugin/Loader.hh>
#include <sdf/Root.hh>
#include <sdf/World.hh>

namespace physics = ignition::physics;
using Duration = std::chrono::steady_clock::duration;
using Features =
    physics::FeatureList<physics::ForwardStep, physics::LinkFrameSemantics,
                         physics::GetModelFromWorld, physics::GetLinkFromModel,
                         physics::sdf::ConstructSdfWorld>;

int main(int, char* argv[]) {
    ignition::plugin::Loader loader;
    loader.LoadLib(argv[1]);
    const auto plugin = loader.Instantiate("ignition::physics::dartsim::Plugin");
    const auto engine = physics::RequestEngine3d<Features>::From(plugin);
    sdf::Root root;
    if (!engine || !root.Load(argv[2]).empty())
        return 1;
    const auto world = engine->ConstructWorld(*root.WorldByIndex(0));
    const std::chrono::duration<double> step(std::atof(argv[3]));
    physics::ForwardStep::Input input;
    physics::ForwardStep::State state;
    physics::ForwardStep::Output output;
    input.Get<Duration>() = std::chrono::duration_cast<Duration>(step);
    for (long i = std::atol(argv[4]); i > 0; i--) {
        world->Step(output, state, input);
        for (std::size_t k = 1; k < world->GetModelCount(); k++) {
            const auto link = world->GetModel(k)->GetLink(0);
            std::printf("%.12g ", link->FrameDataRelativeToWorld().pose.translation().z());
        }
        std::printf("\n");
    }
}
