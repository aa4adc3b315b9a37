// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include <vera/base/version.h>
#include <vera/math/transform.h>

int main() {
    const vera::Affine3 turn = vera::rotation({0, 0, 90});
    const vera::Vec3 turned = transformed_point(turn, {1, 0, 0});
    std::printf("vera %s: %g %g %g\n", vera::version, turned.x, turned.y, turned.z);
    return turned == vera::Vec3{0, 1, 0} ? 0 : 1;
}
