// A ball falls on a wall, or two balls meet, in MercuryDPM; engine_runs.py calls this program as
// engine_mercury, if it is on the PATH.
//
// Its arguments are the radius, the mass, the other mass (0 for a wall), the gap, the speed,
// gravity, the stiffness, the dissipation, the step and the number of steps, in SI units. It writes
// the gap after each step into the file heights.txt.

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "Mercury3D.h"
#include "Species/LinearViscoelasticSpecies.h"
#include "Walls/InfiniteWall.h"

class Drop : public Mercury3D {
  public:
    explicit Drop(char* argv[])
        : radius(std::atof(argv[1])), mass(std::atof(argv[2])), other(std::atof(argv[3])),
          gap(std::atof(argv[4])), speed(std::atof(argv[5])), heights("heights.txt") {
        heights.precision(15);
        setName("drop");
        setFileType(FileType::NO_FILE);
        setGravity(Vec3D(0, 0, -std::atof(argv[6])));
        LinearViscoelasticSpecies species;
        species.setDensity(mass / (4. / 3 * constants::pi * std::pow(radius, 3)));
        species.setStiffness(std::atof(argv[7]));
        species.setDissipation(std::atof(argv[8]));
        speciesHandler.copyAndAddObject(species);
        setTimeStep(std::atof(argv[9]));
        setTimeMax((std::atof(argv[10]) - 0.5) * getTimeStep());
        const double wide = 4 * (radius + std::abs(gap)) + 1;
        setDomain(Vec3D(-wide, -wide, -wide), Vec3D(wide, wide, wide));
    }

    void setupInitialConditions() override {
        // The other ball has the same density; its top is at z = 0, as that of the wall.
        add(radius, radius + gap, -speed);
        if (other > 0) {
            otherRadius = radius * std::cbrt(other / mass);
            add(otherRadius, -otherRadius, 0);
            return;
        }
        InfiniteWall wall;
        wall.setSpecies(speciesHandler.getObject(0));
        wall.set(Vec3D(0, 0, -1), Vec3D(0, 0, 0));
        wallHandler.copyAndAddObject(wall);
    }

    void actionsAfterTimeStep() override {
        double below = 0;
        if (other > 0)
            below = particleHandler.getObject(1)->getPosition().Z + otherRadius;
        heights << particleHandler.getObject(0)->getPosition().Z - radius - below << '\n';
    }

    void printTime() const override {}

  private:
    void add(double size, double height, double velocity) {
        SphericalParticle ball(speciesHandler.getObject(0));
        ball.setRadius(size);
        ball.setPosition(Vec3D(0, 0, height));
        ball.setVelocity(Vec3D(0, 0, velocity));
        particleHandler.copyAndAddObject(ball);
    }

    double radius, mass, other, gap, speed;
    double otherRadius = 0;
    std::ofstream heights;
};

int main(int, char* argv[]) {
    Drop(argv).solve();
}
