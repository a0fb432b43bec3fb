import mujoco

model = mujoco.MjModel.from_xml_string("""<mujoco>
<option timestep="1e-5" gravity="0 0 -9.81"/>
<default><geom condim="1" solref="-1e4 -20" solimp="1e-4 1e-4 0.001"/></default>
<worldbody><geom type="plane" size="1 1 1"/><body pos="0 0 0.1">
<joint type="slide" axis="0 0 1"/><geom type="sphere" size="0.1" mass="1"/></body>
</worldbody></mujoco>""")
data = mujoco.MjData(model)
data.qpos[0] = 1.0
heights = [(mujoco.mj_step(model, data), data.qpos[0])[1] for _ in range(110_000)]
