"""
Recordings: joint states from rosbag2, CSV or npz, as checked columns.

What may change here: file formats, and what is repaired, dropped or refused. Without ROS.

"""
