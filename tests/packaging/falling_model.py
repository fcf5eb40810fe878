"""The smallest model with a device: 1 kg and 2 kg of inertance on a slide."""

MODEL = """
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <worldbody><body><joint name="slide" type="slide"/><geom size="0.1" mass="1"/></body></worldbody>
  <actuator>
    <plugin plugin="inerter.device" joint="slide"><config key="inertance" value="2"/></plugin>
  </actuator>
</mujoco>
"""
