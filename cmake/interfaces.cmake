# Messages, services and actions of the package.
# generate_messages(DEPENDENCIES actionlib_msgs geometry_msgs std_msgs)
